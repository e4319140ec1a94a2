// Renders a scene: the host's side of the wavefront.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accel/bvh.h"
#include "cl/device.h"
#include "scene/scene.h"

namespace wavelobe {

// How the host runs the stages. Both give the same bits.
enum class Driver {
    one_kernel,  // all stages in one launch: a work-item a compute thread, each rendering tile after tile. The faster on CPUs
    staged,      // a launch a stage, over many blocks: stages can be timed and watched one by one
    replay,      // no picture: one path alone, and what it meets
};

// Which samples find direct light. All agree in the mean: those of one kind alone are there to compare with.
enum class Estimator {  // as in kernels/sampling/mis.h
    mis,
    bsdf,   // BSDF samples; light samples only of what these cannot hit
    light,  // light samples; BSDF samples only behind the camera's rays and delta lobes
};

enum class Sampler {
    sobol,        // Owen-scrambled
    independent,  // each sample by itself: to compare with
};

// A path, by the pixel and the sample it is.
struct SampleName {
    int x = 0;
    int y = 0;
    std::uint32_t sample = 0;
};

struct RenderSettings {
    int samples_per_pixel = 16;
    std::uint32_t seed = 0;
    int block_slots = 0;   // paths a block holds at once, a multiple of 16; 0: the default
    Driver driver = Driver::one_kernel;
    double target_error = 0.0;  // relMSE at which a tile takes no more samples; 0: all tiles take all
    double time_limit = 0.0;    // seconds of rendering; 0: none
    Estimator estimator = Estimator::mis;
    Sampler sampler = Sampler::sobol;
    std::optional<int> emission_rays;  // of the camera a sample, for the emitters it sees; 0: paths find them; else by the scene
    bool guide_caustics = true;      // by photons, where light comes through glass or off mirrors (kernels/caustics)
    bool smooth_terminator = false;  // light leaves the curved surface that smooth normals stand for (kernels/shapes/smooth_terminator.h)
    std::optional<BvhQuality> bvh;  // by the number of triangles if there is none
    BuildProgress build_progress;   // told how far the hierarchy is; where it says false, Renderer throws BuildStopped
    bool always_hierarchy = false;  // even where testing all triangles is faster
    int walks_in_turn = 0;          // rays traced in turn; 0: by the size of the hierarchy
    SampleName replayed;            // with Driver::replay
    int lanes = 16;        // width of the stage bodies: 1, 8 or 16; all give the same bits
};

struct StageStats {
    std::string name;
    std::uint64_t launches = 0;  // of the stage; within one kernel, its calls on blocks
    std::uint64_t items = 0;  // paths, rays or samples that went through
    double seconds = 0.0;     // OpenCL event times; within one kernel, its share by the processor's cycle counter
};

// A sample that came out as NaN or infinite: it is left out of the picture and named here.
struct NonFiniteSample {
    SampleName name;
    std::string stage;  // that made it so
};

// One path, as Driver::replay follows it.
struct Replay {
    struct Vertex {
        std::string stage;         // that took the path up; intersect_shadow: a light sample's ray
        std::uint32_t depth = 0;   // of the vertex; not of shadow rays
        bool shadow = false;
        bool emission_ray = false;      // of the camera, for an emitter alone: no vertex of the path
        std::optional<std::uint32_t> shape, primitive;  // that was hit; shadow rays: that they leave
        double distance = 0.0;     // length of the ray
        glm::vec3 position{0.0F};  // of the hit; where the ray starts if nothing was hit, and of shadow rays
        glm::vec3 direction{0.0F};
        glm::vec3 throughput{0.0F};  // shadow rays: what they bring if nothing is in the way
        float pdf = 0.0F;            // that chose the direction; negative: a delta lobe or the camera did
        glm::vec3 radiance{0.0F};    // of the path so far
    };
    std::vector<Vertex> vertices;
    std::uint64_t left_out = 0;  // vertices that were too many
    glm::vec3 radiance{0.0F};    // of the sample
    std::string broken_by;       // the stage, if the radiance is not finite
};

struct RenderStats {
    std::map<std::string, double> setup_parts;  // seconds: parse, bvh, tables, program_build, first_launches
    double render_seconds = 0.0;                // without set-up
    std::uint64_t samples = 0;
    std::optional<double> estimated_error;      // relMSE of the picture, where a target was set
    std::uint64_t nan_samples = 0;
    std::vector<NonFiniteSample> nan_examples;  // the first few
    std::map<std::string, std::uint64_t> rays;  // camera, bounce, shadow
    std::vector<std::string> features;          // what the scene made the program contain
    std::vector<StageStats> stages;
    Replay replay;                              // with Driver::replay
    std::uint64_t device_bytes = 0;             // of all buffers
    std::uint64_t expected_peak_bytes = 0;      // of the process, as it was estimated before

    double setup_seconds() const {
        double sum = 0.0;
        for (const auto& [part, seconds] : setup_parts) sum += seconds;
        return sum;
    }
};

struct ImageChannel {
    std::string name;
    std::vector<float> values;
};

// Linear RGB of the crop window, row by row from the top.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<float> rgb;
    std::vector<ImageChannel> channels{};  // what the scene asks for beside them
};

struct Progress {
    std::uint64_t samples_done = 0;
    double share = 0.0;    // of the work, as far as it can be told
    double seconds = 0.0;  // of rendering
};

// Called between waves; returning false stops rendering with the samples made so far.
using ProgressCallback = std::function<bool(const Progress&)>;

// What a scene needs, known without building any kernel.
struct SceneSummary {
    std::uint64_t triangles = 0;
    std::uint64_t analytic_shapes = 0;
    std::uint64_t lights = 0;
    std::vector<std::string> features;  // lobes, lights, textures ... compiled for it
    std::uint64_t device_bytes = 0;
    std::uint64_t peak_bytes = 0;  // of the process
};

class Renderer {
public:
    // Builds acceleration structure, tables and kernels. Throws InputError if the scene cannot be rendered (say, memory),
    // ClError if OpenCL fails.
    Renderer(const Device& device, const Scene& scene, const RenderSettings& settings);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    // Returns true when every sample was made, false when the callback stopped it.
    bool render(const ProgressCallback& progress = {});

    // Mean of the finite samples made so far; a pixel without samples is black.
    Image image() const;
    const RenderStats& stats() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

SceneSummary summarize(const Scene& scene);

// The OpenCL program of a scene as one source without includes, to read, to lint, or to give to other tools.
std::string scene_program(const Scene& scene, const RenderSettings& settings = {});

}  // namespace wavelobe
