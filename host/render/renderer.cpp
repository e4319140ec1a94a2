#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "cl/cache_lock.h"
#include "cl/kernel_source.h"
#include "cl/program.h"
#include "render/device_buffers.h"
#include "render/flatten.h"
#include "render/render.h"
#include "render/scheduler.h"
#include "render/stage_timer.h"

namespace wavelobe {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr int default_block_slots = 512;
// Blocks in flight a compute thread: enough that a launch outweighs its overhead, few enough that their waves stay in the
// caches of the cores.
constexpr std::size_t blocks_per_thread = 32;
constexpr std::size_t named_nonfinite_samples = 8;

std::uint32_t samples_per_block(int samples_per_pixel) {
    return std::min(static_cast<std::uint32_t>(samples_per_pixel), BLOCK_SAMPLES);
}

// Entries for a hierarchy of `depth` levels: seven siblings a level and the sentinel. In steps, so that most scenes share
// their compiled kernels.
int traversal_stack(int depth) {
    constexpr int step = 64;
    return (7 * depth + 1 + step - 1) / step * step;
}

}  // namespace

struct Renderer::State {
    State(const Device& device_in, const Scene& scene, const RenderSettings& settings_in);

    bool render(const ProgressCallback& progress);
    void run_round();
    void launch(const char* stage, std::uint64_t items);
    void collect_finished();
    std::uint64_t queued(std::uint32_t queue) const;
    bool has_unstarted_paths() const;
    void warm_up();

    const Device& device;
    RenderSettings settings;
    RenderStats stats;
    int slots;
    DeviceScene scene_data;
    TileScheduler scheduler;
    std::size_t block_count;
    DeviceBuffers buffers;
    std::map<std::string, Kernel> kernels;
    StageTimer timer;
    std::span<BlockHeader> headers;
    std::uint64_t samples_done = 0;
};

Renderer::State::State(const Device& device_in, const Scene& scene, const RenderSettings& settings_in)
    : device(device_in),
      settings(settings_in),
      slots(settings_in.block_slots > 0 ? settings_in.block_slots : default_block_slots),
      scene_data([&] {
          const auto start = Clock::now();
          DeviceScene data = flatten_scene(scene);
          data.parameters.seed = settings_in.seed;
          stats.setup_parts["tables"] = seconds_since(start);
          return data;
      }()),
      scheduler(scene_data.parameters, static_cast<std::uint32_t>(settings.samples_per_pixel),
                samples_per_block(settings.samples_per_pixel)),
      block_count(std::min(scheduler.tile_count(), blocks_per_thread * std::max(device.info().compute_units, 1U))),
      buffers(device) {
    auto start = Clock::now();
    const Bvh bvh = build_scene_bvh(scene_data, static_cast<int>(device.info().compute_units));
    scene_data.features.bvh_stack = traversal_stack(bvh.depth);
    const FewTriangleSet few = find_few_triangles(bvh);
    scene_data.features.few_triangles = !few.triangles.empty();
    scene_data.parameters.few_triangle_count = static_cast<std::uint32_t>(few.triangles.size());
    scene_data.parameters.few_vertex_count = static_cast<std::uint32_t>(few.vertices.size() / 3);
    stats.setup_parts["bvh"] = seconds_since(start);

    start = Clock::now();
    buffers.upload(scene_data, bvh, few, block_count, block_words(scene_data.features, slots));
    headers = buffers.view<BlockHeader>("headers");
    stats.device_bytes = buffers.total_bytes();
    stats.features = scene_data.features.names();
    stats.setup_parts["tables"] += seconds_since(start);

    start = Clock::now();
    const CacheLock lock(kernel_cache_folder());
    const Program program(device, program_source(scene_data.features, settings.lanes, slots), "scene.cl");
    for (const std::string& stage : scene_data.features.stages()) {
        Kernel& kernel = kernels.emplace(stage, Kernel(program, stage.c_str())).first->second;
        kernel.bind(buffers.table());
    }
    stats.setup_parts["program_build"] = seconds_since(start);
    start = Clock::now();
    warm_up();
    stats.setup_parts["first_launches"] = seconds_since(start);
}

// PoCL generates a kernel's code at its first launch: done here, on blocks without work.
void Renderer::State::warm_up() {
    for (auto& [name, kernel] : kernels) kernel.launch(device, block_count);
    device.finish();
}

void Renderer::State::launch(const char* stage, std::uint64_t items) {
    if (items == 0) return;
    timer.add(stage, items, kernels.at(stage).launch(device, block_count));
}

std::uint64_t Renderer::State::queued(std::uint32_t queue) const {
    std::uint64_t sum = 0;
    for (const BlockHeader& block : headers) sum += block.count[queue];
    return sum;
}

bool Renderer::State::has_unstarted_paths() const {
    return std::ranges::any_of(headers, [](const BlockHeader& block) { return block.next_path < block.path_count; });
}

// One vertex of every path in flight. The host reads the queues' counts once a round, and launches only what they hold.
void Renderer::State::run_round() {
    std::optional<ClEvent> generate;
    if (has_unstarted_paths()) generate = kernels.at("generate").launch(device, block_count);
    ClEvent intersect = kernels.at("intersect_closest").launch(device, block_count);
    ClEvent sort = kernels.at("sort_paths").launch(device, block_count);
    device.finish();

    std::uint64_t started = 0;
    std::uint64_t traced = 0;
    for (BlockHeader& block : headers) {
        started += std::exchange(block.started, 0);
        traced += block.traced;
    }
    if (generate) timer.add("generate", started, std::move(*generate));
    timer.add("intersect_closest", traced, std::move(intersect));
    timer.add("sort_paths", traced, std::move(sort));
    timer.collect();
    stats.rays["camera"] += started;
    stats.rays["bounce"] += traced - started;

    // Shadow rays of the vertex before go first: a path gains its radiance in order of its vertices.
    const std::uint64_t shadow = queued(QUEUE_SHADOW);
    stats.rays["shadow"] += shadow;
    bool finished = false;
    for (const BlockHeader& block : headers) {
        const std::uint32_t scattering = block.count[QUEUE_DELTA] + block.count[QUEUE_GLOSSY] + block.count[QUEUE_DIFFUSE];
        finished = finished || (block.path_count != 0 && block.next_path >= block.path_count && scattering == 0);
    }
    launch("intersect_shadow", shadow);
    launch("shade_escaped", queued(QUEUE_ESCAPED));
    launch("shade_emitted", queued(QUEUE_EMITTED));
    launch("scatter_delta", queued(QUEUE_DELTA));
    launch("scatter_glossy", queued(QUEUE_GLOSSY));
    launch("scatter_diffuse", queued(QUEUE_DIFFUSE));
    if (finished) collect_finished();
}

void Renderer::State::collect_finished() {
    std::vector<bool> busy(headers.size());
    for (std::size_t i = 0; i < headers.size(); ++i) busy[i] = headers[i].path_count != 0;
    ClEvent event = kernels.at("accumulate").launch(device, block_count);
    device.finish();
    std::uint64_t collected = 0;
    for (std::size_t i = 0; i < headers.size(); ++i) {
        if (!busy[i] || headers[i].path_count != 0) continue;
        collected += scheduler.finish(i);
        const std::uint32_t bad = headers[i].nonfinite_path;
        if (bad != WAVELOBE_NONE && stats.nan_examples.size() < named_nonfinite_samples) {
            const std::uint32_t pixel = bad % TILE_PIXELS;
            stats.nan_examples.push_back({static_cast<int>(headers[i].tile_x + TILE_X(pixel)),
                                          static_cast<int>(headers[i].tile_y + TILE_Y(pixel)),
                                          headers[i].first_sample + bad / TILE_PIXELS});
        }
    }
    timer.add("accumulate", collected, std::move(event));
    samples_done += collected;
}

bool Renderer::State::render(const ProgressCallback& progress) {
    const auto start = Clock::now();
    // Not even emitters are seen along a path of no edges.
    const bool anything = scene_data.parameters.max_depth > 0;
    bool complete = true;
    while (anything && scheduler.assign(headers) > 0) {
        run_round();
        if (progress && !progress({samples_done, scheduler.total_samples(), seconds_since(start)})) {
            complete = samples_done == scheduler.total_samples();
            break;
        }
    }
    device.finish();
    timer.collect();
    stats.render_seconds = seconds_since(start);
    stats.samples = samples_done;
    stats.stages = timer.rows(scene_data.features.stages());
    stats.nan_samples = 0;
    for (const FilmPixel& pixel : buffers.view<FilmPixel>("film")) stats.nan_samples += pixel.nonfinite;
    return complete;
}

Renderer::Renderer(const Device& device, const Scene& scene, const RenderSettings& settings)
    : state_(std::make_unique<State>(device, scene, settings)) {}

Renderer::~Renderer() = default;

bool Renderer::render(const ProgressCallback& progress) { return state_->render(progress); }

const RenderStats& Renderer::stats() const { return state_->stats; }

Image Renderer::image() const {
    const RenderParameters& p = state_->scene_data.parameters;
    Image image{static_cast<int>(p.window_width), static_cast<int>(p.window_height), {}};
    image.rgb.reserve(std::size_t{3} * p.window_width * p.window_height);
    for (const FilmPixel& pixel : state_->buffers.view<FilmPixel>("film")) {
        for (const double sum : pixel.sum) {
            image.rgb.push_back(pixel.samples > 0 ? static_cast<float>(sum / pixel.samples) : 0.0F);
        }
    }
    return image;
}

std::string scene_program(const Scene& scene, const RenderSettings& settings) {
    const FeatureSet features = flatten_scene(scene).features;
    const int slots = settings.block_slots > 0 ? settings.block_slots : default_block_slots;
    return flatten_includes(program_source(features, settings.lanes, slots), "scene.cl");
}

SceneSummary summarize(const Scene& scene) {
    const DeviceScene data = flatten_scene(scene);
    return {data.triangles.size(), data.analytics.size(), data.lights.size(), data.features.names(),
            estimate_device_bytes(data)};
}

}  // namespace wavelobe
