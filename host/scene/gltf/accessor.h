// Accessors: arrays of numbers in buffers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/gltf/document.h"

namespace wavelobe::gltf {

// Element i of accessor a: components a.components, each from a view by offset and stride; `sparse` ones replaced.
struct Accessor {
    std::size_t count = 0;
    std::size_t components = 0;  // numbers an element
    int component_type = 0;      // GL's: 5120 signed byte ... 5126 float
    bool normalized = false;
    std::string type;  // such as VEC3
    bool readable = false;
};

// Checks all accessors of a document against their buffers, and reads them.
class Accessors {
public:
    explicit Accessors(Document& document);

    std::size_t size() const { return list_.size(); }
    const Accessor& operator[](std::size_t i) const { return list_[i]; }

    // Whether anything says what the numbers are, which are 0 otherwise.
    bool has_data(std::size_t i) const { return blocks_[i].data != nullptr || !sparse_[i].indices.empty(); }

    // A fault of `owner` where the accessor that its member `name` refers to is in a view with a stride, which vertices alone may have:
    // readers differ on what that means.
    void refuse_stride(const Element& owner, const char* name) const;

    // All numbers, element by element, as floats: normalized integers in [0, 1] or [-1, 1]. Empty after a fault.
    std::vector<float> floats(std::size_t i) const;
    // The same of unsigned integers.
    std::vector<std::uint32_t> integers(std::size_t i) const;

private:
    struct Block {  // where elements lie
        const char* data = nullptr;  // null: all zero
        std::size_t stride = 0;
    };
    struct Extent {  // in bytes
        std::size_t element;    // from one to the next where they are packed
        std::size_t last;       // read of the last
        std::size_t alignment;  // of each number
    };
    struct Sparse {
        std::vector<std::uint32_t> indices;
        Block values;
    };

    static Extent extent_of(const Accessor& a);
    void check(std::size_t i);
    void check_sparse(std::size_t i);
    void check_values(std::size_t i);
    Block block(const Element& place, std::size_t count, const Extent& extent, bool interleaved);
    template <class Out, class Convert>
    void read(std::size_t i, std::vector<Out>& out, Convert convert) const;

    Document& document_;
    std::vector<Accessor> list_;
    std::vector<Block> blocks_;
    std::vector<Sparse> sparse_;
};

}  // namespace wavelobe::gltf
