#include "render/memory.h"

#include <unistd.h>

#include <algorithm>
#include <limits>

#include "render/flatten_caustics.h"
#include "scene/fault.h"
#include "shared/block.h"

namespace wavelobe {
namespace {

// Measured on meshes of 10 thousand to 10 million triangles, which need 57 to 90.
constexpr std::uint64_t hierarchy_bytes_per_primitive = 65;
constexpr std::uint64_t hierarchy_bytes_per_instance = 50;
// While it is built: boxes, the builder's tree, and the hierarchy itself.
constexpr std::uint64_t build_bytes_per_primitive = 178;
// The program with its libraries, kernels that are compiled already among them.
constexpr std::uint64_t program_bytes = std::uint64_t{90} << 20U;
// Of a pixel once it is rendered: sums as they are read back, colours, and the file.
constexpr std::uint64_t picture_bytes_per_pixel = 56;

template <class T>
std::uint64_t bytes_of(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

// Arrays that go to the device as they are; the hierarchy and the film are not among them.
std::uint64_t array_bytes(const DeviceScene& data) {
    return bytes_of(data.primitive_shapes) + bytes_of(data.shapes) + bytes_of(data.normals) + bytes_of(data.uvs) + bytes_of(data.colors) +
           bytes_of(data.analytics) + bytes_of(data.instances) + bytes_of(data.materials) + bytes_of(data.opacities) +
           bytes_of(data.textures) + bytes_of(data.texels) + bytes_of(data.media) + bytes_of(data.shape_media) + bytes_of(data.lights) +
           bytes_of(data.light_tree) + bytes_of(data.environment_texels) + bytes_of(data.environment_sums) +
           bytes_of(data.environment_density);
}

std::uint64_t pixels_of(const DeviceScene& data) {
    return std::uint64_t{data.parameters.window_width} * data.parameters.window_height;
}

std::uint64_t mesh_bytes(const std::vector<Shape>& shapes) {
    std::uint64_t sum = bytes_of(shapes);
    for (const Shape& shape : shapes) {
        const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry);
        if (mesh == nullptr) continue;
        sum += bytes_of(mesh->positions) + bytes_of(mesh->normals) + bytes_of(mesh->tangents) + bytes_of(mesh->uvs) + bytes_of(mesh->second_uvs) +
               bytes_of(mesh->colors) + bytes_of(mesh->alphas) + bytes_of(mesh->triangles);
    }
    return sum;
}

// Each image that is used has its copy among the texels.
std::uint64_t scene_bytes(const Scene& scene, const DeviceScene& data) {
    std::uint64_t sum = mesh_bytes(scene.shapes) + bytes_of(data.texels) + bytes_of(data.environment_texels);
    for (const ShapeGroup& group : scene.groups) sum += mesh_bytes(group.shapes);
    return sum + bytes_of(scene.instances);
}

}  // namespace

MemoryEstimate estimate_memory(const Scene& scene, const DeviceScene& data) {
    const std::uint64_t primitives = data.primitive_shapes.size(), arrays = array_bytes(data);
    const std::size_t sums = data.features.layer_channels() + (data.features.moments ? MOMENT_CHANNELS : 0);
    const std::uint64_t halves = data.features.error_estimate ? 2 : 1;
    const std::uint64_t film = pixels_of(data) * (halves * sizeof(FilmPixel) + sums * sizeof(double));
    const std::uint64_t hierarchy = primitives * hierarchy_bytes_per_primitive + data.instances.size() * hierarchy_bytes_per_instance;

    MemoryEstimate estimate;
    estimate.device_bytes = film + hierarchy + arrays + (data.features.caustics ? caustic_bytes(data.caustic_grid) : 0);
    const std::uint64_t host = program_bytes + scene_bytes(scene, data) + arrays + bytes_of(data.triangles) + bytes_of(data.instance_bounds);
    const std::uint64_t building = primitives * build_bytes_per_primitive;
    const std::uint64_t uploading = hierarchy + estimate.device_bytes;
    const std::uint64_t writing = estimate.device_bytes + pixels_of(data) * picture_bytes_per_pixel;
    estimate.peak_bytes = host + std::max({building, uploading, writing});
    return estimate;
}

void refuse_beyond(const MemoryEstimate& estimate, std::uint64_t memory_bytes) {
    if (estimate.peak_bytes <= memory_bytes) return;
    throw InputError(Fault{"", 0, 0, "scene",
                           "takes about " + std::to_string(estimate.peak_bytes >> 20U) + " MiB of memory, " +
                               std::to_string(estimate.device_bytes >> 20U) + " MiB of them the kernels' buffers; the machine has " +
                               std::to_string(memory_bytes >> 20U) + " MiB",
                           "use smaller meshes or images, instances, or a smaller picture"});
}

std::uint64_t physical_memory() {
    const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    if (pages <= 0 || size <= 0) return std::numeric_limits<std::uint64_t>::max();
    return static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(size);
}

}  // namespace wavelobe
