// The buffers of a render, by the names kernels give their parameters.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "accel/few_triangles.h"
#include "cl/program.h"
#include "render/flatten.h"

namespace wavelobe {

// Writes the roots of the groups into the instances. Without a quality by the number of triangles.
Bvh build_scene_bvh(DeviceScene& scene, int threads, std::optional<BvhQuality> quality = std::nullopt,
                    const BuildProgress& progress = {});

class DeviceBuffers {
public:
    explicit DeviceBuffers(const Device& device) : device_(device) {}

    // The scene and the film.
    void upload(const DeviceScene& scene, const Bvh& bvh, const FewTriangleSet& few);

    // Blocks without work.
    void add_blocks(std::size_t count, std::size_t words_each);

    template <class T>
    void add_zeros(const std::string& name, std::size_t count) {
        insert(name, Buffer(device_, count * sizeof(T)));
    }

    // Of what no later kernel asks for.
    void remove(const std::string& name) {
        table_.erase(name);
        buffers_.erase(name);
    }

    const BufferTable& table() const { return table_; }
    std::uint64_t total_bytes() const;

    template <class T>
    std::span<T> view(const std::string& name) const {
        return buffers_.at(name).view<T>();
    }

private:
    // Arrays without elements get no buffer: no kernel of the scene asks for them.
    template <class T>
    void add(const std::string& name, const std::vector<T>& values) {
        if (!values.empty()) insert(name, Buffer::of<T>(device_, values));
    }
    // With room behind them for what is read at once (kernels/core/rows.h).
    void add_rows(const std::string& name, std::span<const float> values);
    void add_few(const DeviceScene& scene, const Bvh& bvh, const FewTriangleSet& few);
    void add_caustics(const DeviceScene& scene);
    void insert(const std::string& name, Buffer buffer);

    const Device& device_;
    std::map<std::string, Buffer> buffers_;
    BufferTable table_;
};

}  // namespace wavelobe
