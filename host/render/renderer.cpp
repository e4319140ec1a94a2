#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>

#include "cl/cache_lock.h"
#include "cl/kernel_source.h"
#include "cl/program.h"
#include "render/driver.h"
#include "render/flatten.h"
#include "render/flatten_caustics.h"
#include "render/memory.h"
#include "render/photons.h"
#include "render/picture_channels.h"
#include "scene/fault.h"

namespace wavelobe {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr int default_block_slots = 512;
constexpr double no_limit = std::numeric_limits<double>::infinity();
constexpr std::size_t named_nonfinite_samples = 8;

SamplePlan sample_plan(const RenderSettings& settings) {
    return {.samples_per_pixel = static_cast<std::uint32_t>(settings.samples_per_pixel),
            // The halves of an estimate take whole ranges in turn.
            .growing_ranges = settings.time_limit > 0.0 && !(settings.target_error > 0.0),
            .target_error = settings.target_error};
}

// Entries for a hierarchy of `depth` levels: seven siblings a level, the sentinel and the way back from an instance. In steps, so that most scenes share
// their compiled kernels.
int traversal_stack(int depth) {
    constexpr int step = 64;
    return (7 * depth + 2 + step - 1) / step * step;
}

// Before anything large is allocated.
void refuse_large_film(const Device& device, const DeviceScene& scene) {
    const RenderParameters& p = scene.parameters;
    const std::uint64_t pixels = std::uint64_t{p.window_width} * p.window_height;
    const std::uint64_t bytes = pixels * sizeof(FilmPixel) * (scene.features.error_estimate ? 2 : 1);
    const std::uint64_t layers = pixels * scene.features.layer_channels() * sizeof(double);
    const std::uint64_t moments = scene.features.moments ? pixels * MOMENT_CHANNELS * sizeof(double) : 0;
    const std::uint64_t largest = std::max({bytes, layers, moments}), most = device.info().max_allocation_bytes;
    if (largest <= most) return;
    throw InputError(Fault{"", 0, 0, "film",
                           std::to_string(p.window_width) + " x " + std::to_string(p.window_height) + " pixels take " +
                               std::to_string(largest >> 20U) + " MiB at once; the device allows " + std::to_string(most >> 20U) + " MiB",
                           "render a smaller picture, or a window of it with --crop"});
}

// Whether error or time end a picture, and not its number of samples.
bool has_open_end(const RenderSettings& settings) { return settings.target_error > 0.0 || settings.time_limit > 0.0; }

// As Mitsuba scales its ray differentials; where the number of samples is open, a whole pixel.
float layer_film_step(const RenderSettings& settings) {
    return has_open_end(settings) ? 1.0F : 1.0F / std::sqrt(static_cast<float>(std::max(settings.samples_per_pixel, 1)));
}

// About how many samples a picture will have.
std::uint64_t expected_samples(const RenderSettings& settings, const Film& film) {
    constexpr double of_open_pixels = 1024.0, a_second = 1e6;
    const double samples = static_cast<double>(film.width) * film.height * (has_open_end(settings) ? of_open_pixels : settings.samples_per_pixel);
    return static_cast<std::uint64_t>(settings.time_limit > 0.0 ? std::min(samples, settings.time_limit * a_second) : samples);
}

// How many binary digits number the samples of a pixel.
std::uint32_t sample_digits(const RenderSettings& settings) {
    if (has_open_end(settings)) return SEQUENCE_A_PIXEL;
    return static_cast<std::uint32_t>(std::bit_width(static_cast<unsigned>(std::max(settings.samples_per_pixel, 1) - 1)));
}

// The scene as the device has it, with what the settings ask of its kernels.
DeviceScene device_scene(const Scene& scene, const RenderSettings& settings) {
    DeviceScene data = flatten_scene(scene, settings.estimator);
    data.parameters.sequence = {settings.seed, sample_digits(settings)};
    data.parameters.layer_film_step = layer_film_step(settings);
    data.features.independent_samples = settings.sampler == Sampler::independent;
    set_photon_count(data, expected_samples(settings, scene.film));
    if (settings.emission_rays) data.features.emission_rays = *settings.emission_rays;
    data.features.caustics = data.features.caustics && settings.guide_caustics;
    data.features.smooth_terminator = settings.smooth_terminator && data.features.smooth_normals;
    data.features.error_estimate = settings.target_error > 0.0;
    return data;
}

struct TraversalData {
    Bvh bvh;
    FewTriangleSet few;  // empty where the hierarchy is to be walked
};

// Builds what rays meet, and enters into the scene's features how they are traced.
TraversalData build_traversal(DeviceScene& scene, int threads, const RenderSettings& settings) {
    TraversalData data{build_scene_bvh(scene, threads, settings.bvh, settings.build_progress), {}};
    scene.features.bvh_stack = traversal_stack(data.bvh.depth);
    // Rays that go in groups can be taken in turn (HAS_PACKETS of kernels/shapes/packet.h).
    const bool grouped = !scene.features.analytic && !scene.features.instances && !scene.features.masks;
    if (grouped) scene.features.walks = settings.walks_in_turn > 0 ? settings.walks_in_turn : walks_in_turn(data.bvh);
    const bool hierarchy = scene.features.instances || settings.always_hierarchy;
    if (!hierarchy) data.few = find_few_triangles(data.bvh, scene.analytic_bounds);
    scene.features.few_triangles = !data.few.triangles.empty();
    scene.parameters.few = data.few.summary;
    return data;
}

int slots_of(const RenderSettings& settings) {
    return settings.block_slots > 0 ? settings.block_slots : default_block_slots;
}

}  // namespace

void note_nonfinite(RenderStats& stats, const TileRange& range, std::uint32_t path, std::uint32_t stage) {
    if (path == WAVELOBE_NONE || stats.nan_examples.size() >= named_nonfinite_samples) return;
    const std::uint32_t digits = PATH_DIGITS(range.samples), pixel = PATH_PIXEL(path, digits);
    const SampleName name{static_cast<int>(range.x + TILE_X(pixel)), static_cast<int>(range.y + TILE_Y(pixel)),
                          range.first_sample + PATH_SAMPLE(path, digits)};
    stats.nan_examples.push_back({name, stage_name(stage)});
}

struct Renderer::State {
    State(const Device& device_in, const Scene& scene, const RenderSettings& settings_in);

    bool render(const ProgressCallback& progress);
    void build_geometry();
    void build_program();
    void count_rays();

    const Device& device;
    RenderSettings settings;
    RenderStats stats;
    int slots;
    DeviceScene scene_data;
    TileScheduler scheduler;
    DeviceBuffers buffers;
    StageTimer timer;
    std::unique_ptr<BlockDriver> driver;
    std::optional<PhotonPass> photons;  // of scenes with caustics, until it has run
};

Renderer::State::State(const Device& device_in, const Scene& scene, const RenderSettings& settings_in)
    : device(device_in),
      settings(settings_in),
      slots(slots_of(settings_in)),
      scene_data([&] {
          const auto start = Clock::now();
          DeviceScene data = device_scene(scene, settings_in);
          refuse_large_film(device_in, data);
          const MemoryEstimate memory = estimate_memory(scene, data);
          refuse_beyond(memory, physical_memory());
          stats.expected_peak_bytes = memory.peak_bytes;
          stats.setup_parts["tables"] = seconds_since(start);
          return data;
      }()),
      scheduler(scene_data.parameters, sample_plan(settings),
                settings.driver == Driver::staged ? TileOrder::mixed : TileOrder::rows),
      buffers(device) {
    build_geometry();
    const auto start = Clock::now();
    const RenderContext context{device, scene_data.features, buffers, scheduler, timer, stats, slots};
    switch (settings.driver) {
        case Driver::one_kernel: driver = make_one_kernel_driver(context); break;
        case Driver::staged: driver = make_staged_driver(context); break;
        case Driver::replay:
            settings.lanes = 1;
            driver = make_replay_driver(context, settings.replayed);
            break;
    }
    stats.device_bytes = buffers.total_bytes();
    stats.features = scene_data.features.names();
    stats.setup_parts["tables"] += seconds_since(start);
    build_program();
}

void Renderer::State::build_geometry() {
    auto start = Clock::now();
    const TraversalData traversal = build_traversal(scene_data, static_cast<int>(device.info().compute_units), settings);
    stats.setup_parts["bvh"] = seconds_since(start);
    start = Clock::now();
    buffers.upload(scene_data, traversal.bvh, traversal.few);
    stats.setup_parts["tables"] += seconds_since(start);
}

void Renderer::State::build_program() {
    auto start = Clock::now();
    const CacheLock lock(kernel_cache_folder());
    const Program program(device, program_source(scene_data.features, settings.lanes, slots, settings.driver), "scene.cl");
    stats.setup_parts["program_build"] = seconds_since(start);
    start = Clock::now();
    driver->prepare(program);
    if (scene_data.features.caustics) photons.emplace(device, buffers, program);
    stats.setup_parts["first_launches"] = seconds_since(start);
}

void Renderer::State::count_rays() {
    const std::uint64_t camera = timer.items(STAGE_GENERATE);
    stats.rays["camera"] = camera;
    stats.rays["bounce"] = timer.items(STAGE_INTERSECT_CLOSEST) - camera;
    stats.rays["shadow"] = timer.items(STAGE_INTERSECT_SHADOW);
}

bool Renderer::State::render(const ProgressCallback& progress) {
    const auto start = Clock::now();
    // Not even emitters are seen along a path of no edges.
    const bool anything = scene_data.parameters.max_depth > 0;
    if (photons) photons->shoot();
    photons.reset();
    while (anything && !scheduler.finished()) {
        if (settings.driver == Driver::replay) {
            driver->step(no_limit);
            return true;
        }
        const double left = settings.time_limit > 0.0 ? settings.time_limit - seconds_since(start) : no_limit;
        // However little time there is, there is a picture.
        if (left <= 0.0 && scheduler.samples_done() > 0) break;
        driver->step(std::max(left, 0.0));
        const double seconds = seconds_since(start);
        const double share = std::max(scheduler.share_done(), settings.time_limit > 0.0 ? seconds / settings.time_limit : 0.0);
        if (progress && !progress({scheduler.samples_done(), std::min(share, 1.0), seconds})) break;
    }
    driver->wait();
    stats.render_seconds = seconds_since(start);
    stats.samples = scheduler.samples_done();
    stats.stages = timer.rows(scene_data.features);
    count_rays();
    if (settings.target_error > 0.0) stats.estimated_error = scheduler.estimated_error();
    stats.nan_samples = 0;
    for (const FilmPixel& pixel : buffers.view<FilmPixel>("film")) stats.nan_samples += pixel.nonfinite;
    const bool out_of_time = settings.time_limit > 0.0 && stats.render_seconds >= settings.time_limit;
    return !anything || scheduler.finished() || out_of_time;
}

Renderer::Renderer(const Device& device, const Scene& scene, const RenderSettings& settings)
    : state_(std::make_unique<State>(device, scene, settings)) {}

Renderer::~Renderer() = default;

bool Renderer::render(const ProgressCallback& progress) { return state_->render(progress); }

const RenderStats& Renderer::stats() const { return state_->stats; }

Image Renderer::image() const {
    const DeviceScene& scene = state_->scene_data;
    const RenderParameters& p = scene.parameters;
    Image image{static_cast<int>(p.window_width), static_cast<int>(p.window_height), {}};
    const std::size_t pixels = std::size_t{p.window_width} * p.window_height;
    const std::vector<PixelSums> sums = pixel_sums(state_->buffers.view<FilmPixel>("film"), pixels);
    image.rgb.reserve(3 * pixels);
    for (const PixelSums& pixel : sums) {
        for (const double channel : pixel.sum) {
            image.rgb.push_back(scene.radiance && pixel.samples > 0.0 ? static_cast<float>(channel / pixel.samples) : 0.0F);
        }
    }
    for (const PictureChannel& channel : scene.channels) {
        image.channels.push_back({channel.name, channel_values(scene, state_->buffers, channel, sums)});
    }
    return image;
}

std::string scene_program(const Scene& scene, const RenderSettings& settings) {
    DeviceScene data = device_scene(scene, settings);
    build_traversal(data, static_cast<int>(std::max(std::thread::hardware_concurrency(), 1U)), settings);
    return flatten_includes(program_source(data.features, settings.lanes, slots_of(settings), settings.driver), "scene.cl");
}

SceneSummary summarize(const Scene& scene) {
    const DeviceScene data = flatten_scene(scene);
    const MemoryEstimate memory = estimate_memory(scene, data);
    return {data.triangles.size(), data.analytics.size(), data.lights.size(), data.features.names(),
            memory.device_bytes, memory.peak_bytes};
}

}  // namespace wavelobe
