// Rays a second of our traversal kernels and of Embree, in one process, on the same meshes and rays, taking turns.
// Writes JSON to standard output; scripts/benchmarks/traversal.py makes tables of it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <map>
#include <thread>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include "our_kernels.h"

namespace {

using namespace wavelobe;
using namespace wavelobe::benchmark;

struct Options {
    int threads = 1;
    std::size_t side = 512;  // of the picture whose camera rays are traced
    int rounds = 5;
    std::vector<std::string> meshes;
    std::string scene;  // a Mitsuba scene for the mesh called `scene`
    bool best = true;
};

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

// Seconds of Embree on all rays, shared by the threads in chunks.
double time_embree(const EmbreeScene& scene, const RaySet& rays, EmbreeScene::Mode mode, bool coherent, int threads,
                   std::vector<float>& t, std::vector<std::uint32_t>& primitives) {
    const double start = seconds();
    std::vector<std::thread> workers;
    const auto part = [&](int k) {
        // As Embree's manual recommends.
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
        const auto n = static_cast<std::size_t>(threads);
        const std::size_t chunk = (rays.count / 64 + n - 1) / n * 64;
        const std::size_t first = std::min(static_cast<std::size_t>(k) * chunk, rays.count);
        scene.trace(rays, first, std::min(first + chunk, rays.count), mode, coherent, t.data(), primitives.data());
    };
    for (int k = 1; k < threads; ++k) workers.emplace_back(part, k);
    part(0);
    for (std::thread& worker : workers) worker.join();
    return seconds() - start;
}

// Rays on which the two disagree about hit or miss, or about the distance by more than 1e-5.
std::size_t disagreements(const RaySet& rays, const float* ours, const float* theirs) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.count; ++i) {
        const bool both_end = std::isinf(ours[i]) && ours[i] == theirs[i];
        if (!both_end && !(std::abs(ours[i] - theirs[i]) <= 1e-5F * std::abs(theirs[i]))) ++count;
    }
    return count;
}

constexpr const char* mode_names[] = {"1", "8", "16", "stream"};

struct Contest {
    const Device& device;
    const EmbreeScene& fast;
    const EmbreeScene& robust;
    OurKernels& ours;
    OurKernels& portable;
};

nlohmann::json measure(const Options& options, const Contest& c, const RaySet& rays) {
    const Buffer ray_buffer = Buffer::of<float>(c.device, rays.values);
    const Buffer hits(c.device, 2 * rays.count * sizeof(float));
    std::vector<float> t(rays.count);
    std::vector<std::uint32_t> primitives(rays.count);
    std::map<std::string, std::vector<double>> times;
    c.ours.trace(rays.any_hit, rays.count, ray_buffer, hits);  // PoCL generates code at the first launch
    time_embree(c.robust, rays, EmbreeScene::Mode::single, false, options.threads, t, primitives);
    const std::size_t unlike = disagreements(rays, hits.view<float>().data(), t.data());
    c.portable.trace(rays.any_hit, rays.count, ray_buffer, hits);
    for (int round = 0; round < options.rounds; ++round) {
        times["ours"].push_back(c.ours.trace(rays.any_hit, rays.count, ray_buffer, hits));
        times["portable"].push_back(c.portable.trace(rays.any_hit, rays.count, ray_buffer, hits));
        for (int mode = 0; mode < 4; ++mode) {
            for (const bool coherent : {false, true}) {
                const std::string name = std::string(mode_names[mode]) + (coherent ? " coherent" : "");
                const auto m = static_cast<EmbreeScene::Mode>(mode);
                times["embree " + name].push_back(time_embree(c.fast, rays, m, coherent, options.threads, t, primitives));
                times["robust " + name].push_back(time_embree(c.robust, rays, m, coherent, options.threads, t, primitives));
            }
        }
    }
    nlohmann::json row;
    std::map<std::string, double> best;
    for (const auto& [name, values] : times) {
        const double rate = 1e-6 * static_cast<double>(rays.count) / median(values);
        const std::string kind = name.substr(0, name.find(' '));
        if (rate > best[kind]) {
            best[kind] = rate;
            if (kind != name) row[kind + "_mode"] = name.substr(kind.size() + 1);
        }
    }
    row["rays"] = rays.name;
    row["threads"] = options.threads;
    row["ours"] = best["ours"];
    row["portable"] = best["portable"];
    row["embree_best"] = best["embree"];
    row["embree_best_robust"] = best["robust"];
    row["ratio"] = best["ours"] / best["embree"];
    row["ratio_robust"] = best["ours"] / best["robust"];
    row["disagreements"] = unlike;
    return row;
}

// Rooms by the cells along a side of their ornaments: 200 cells^2 * 2 triangles, or nearly.
constexpr std::pair<const char*, int> rooms[] = {{"room-1k", 2}, {"room-9k", 5}, {"room-99k", 16}, {"room-990k", 50}, {"room-10M", 158}};

BenchmarkMesh make_mesh(const std::string& name, const std::string& scene) {
    if (name == "box") return box_mesh();
    if (name == "scene" && !scene.empty()) return scene_mesh(name, scene);
    std::string known = "box";
    for (const auto& [room, cells] : rooms) {
        if (name == room) return room_mesh(name, cells);
        known += std::string(", ") + room;
    }
    throw std::runtime_error("no mesh called '" + name + "': " + known + ", or scene with --scene FILE");
}

void run(const Options& options) {
    DeviceOptions device_options;
    device_options.threads = options.threads;
    const Device device(device_options);
    nlohmann::json result = {{"rows", nlohmann::json::array()}, {"build", nlohmann::json::array()}};
    for (const std::string& name : options.meshes) {
        const BenchmarkMesh mesh = make_mesh(name, options.scene);
        const Bvh bvh = build_bvh(mesh.triangles, {}, options.best ? BvhQuality::best : BvhQuality::fast, options.threads);
        const double bytes = static_cast<double>(bvh.nodes.size() * sizeof(BvhNode) + bvh.blocks.size() * sizeof(TriangleBlock));
        result["build"].push_back({{"mesh", name}, {"triangles", mesh.triangles.size()}, {"threads", options.threads},
                                   {"seconds", bvh.build_seconds},
                                   {"bytes_per_triangle", bytes / static_cast<double>(mesh.triangles.size())}});
        const EmbreeScene fast(mesh, false, options.threads);
        const EmbreeScene robust(mesh, true, options.threads);
        const MeshBuffers buffers(device, bvh, find_few_triangles(bvh));
        OurKernels ours(device, buffers, "");
        OurKernels portable(device, buffers, "-DWAVELOBE_PORTABLE");
        const Contest contest{device, fast, robust, ours, portable};
        for (const RaySet& rays : ray_sets(mesh, robust, options.side)) {
            nlohmann::json row = measure(options, contest, rays);
            row["mesh"] = name;
            row["triangles"] = mesh.triangles.size();
            result["rows"].push_back(row);
            std::cerr << name << " " << rays.name << ": " << row["ours"] << " M/s, Embree " << row["embree_best"] << ", robust "
                      << row["embree_best_robust"] << "\n";
        }
    }
    std::cout << result.dump(1) << "\n";
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    options.meshes = {"box", "room-99k"};
    std::string quality = "best";
    CLI::App app("Rays a second beside Embree");
    app.add_option("--threads", options.threads, "compute threads")->check(CLI::PositiveNumber);
    app.add_option("--side", options.side, "camera rays a side, a multiple of 16");
    app.add_option("--rounds", options.rounds, "medians of this many rounds")->check(CLI::PositiveNumber);
    app.add_option("--meshes", options.meshes, "box, room-1k, room-9k, room-99k, room-990k, room-10M, scene");
    app.add_option("--scene", options.scene, "Mitsuba scene for the mesh `scene`");
    app.add_option("--quality", quality, "of the hierarchy")->check(CLI::IsMember({"fast", "best"}));
    CLI11_PARSE(app, argc, argv);
    options.best = quality == "best";
    options.side = std::max<std::size_t>(options.side / 16 * 16, 16);
    try {
        run(options);
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << "\n";
        return 1;
    }
}
