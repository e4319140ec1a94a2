#include "scene/gltf/accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include <fmt/format.h>

namespace wavelobe::gltf {

namespace {

// Without a buffer view an accessor is all zero, and no buffer bounds its size.
constexpr std::size_t most_zeros = std::size_t{1} << 26;

struct Shape {
    std::size_t columns, rows;
};

const std::map<std::string, Shape>& shapes() {
    static const std::map<std::string, Shape> known{{"SCALAR", {1, 1}}, {"VEC2", {1, 2}}, {"VEC3", {1, 3}}, {"VEC4", {1, 4}},
                                                    {"MAT2", {2, 2}},   {"MAT3", {3, 3}}, {"MAT4", {4, 4}}};
    return known;
}

std::size_t component_bytes(int type) {
    switch (type) {
        case 5120:
        case 5121: return 1;
        case 5122:
        case 5123: return 2;
        case 5125:
        case 5126: return 4;
        default: return 0;
    }
}

// Columns of matrices start on multiples of four bytes.
std::size_t column_bytes(const Shape& shape, int component_type) {
    const std::size_t bytes = shape.rows * component_bytes(component_type);
    return shape.columns == 1 ? bytes : (bytes + 3) / 4 * 4;
}

bool is_matrix(const Element& accessor) { return accessor.text("type").starts_with("MAT"); }

template <class T>
T number_at(const char* data) {
    T value;
    std::memcpy(&value, data, sizeof value);
    return value;
}

float signed_part(float value, float most) { return std::max(value / most, -1.0F); }

float float_at(const char* data, int type, bool normalized) {
    switch (type) {
        case 5120: {
            const auto value = static_cast<float>(number_at<std::int8_t>(data));
            return normalized ? signed_part(value, 127.0F) : value;
        }
        case 5121: {
            const auto value = static_cast<float>(number_at<std::uint8_t>(data));
            return normalized ? value / 255.0F : value;
        }
        case 5122: {
            const auto value = static_cast<float>(number_at<std::int16_t>(data));
            return normalized ? signed_part(value, 32767.0F) : value;
        }
        case 5123: {
            const auto value = static_cast<float>(number_at<std::uint16_t>(data));
            return normalized ? value / 65535.0F : value;
        }
        case 5125: return static_cast<float>(number_at<std::uint32_t>(data));
        default: return number_at<float>(data);
    }
}

std::uint32_t integer_at(const char* data, int type, bool) {
    switch (type) {
        case 5121: return number_at<std::uint8_t>(data);
        case 5123: return number_at<std::uint16_t>(data);
        default: return number_at<std::uint32_t>(data);
    }
}

}  // namespace

Accessors::Accessors(Document& document)
    : document_(document), list_(document.accessors.size()), blocks_(list_.size()), sparse_(list_.size()) {
    for (std::size_t i = 0; i < list_.size(); ++i) check(i);
}

// The place of `count` elements in the view that `place` names.
// `element_bytes` lie between elements, and `last_bytes` are read of the last.
Accessors::Block Accessors::block(const Element& place, std::size_t count, const Extent& extent, bool interleaved) {
    const auto [element_bytes, last_bytes, alignment] = extent;
    const auto index = place.index("bufferView", document_.views.size(), "buffer views");
    const auto offset = static_cast<std::size_t>(place.whole("byteOffset", 0, 0, std::int64_t{1} << 50));
    if (!index || !document_.views[*index].readable) return {};
    const BufferView& view = document_.views[*index];
    const std::size_t stride = interleaved && view.stride > 0 ? view.stride : element_bytes;
    if (stride < element_bytes) {
        place.fault(fmt::format("elements of {} bytes in buffer view {}, whose stride is {}", element_bytes, *index, stride));
        return {};
    }
    // Matrices have columns that start on multiples of four bytes.
    if (offset % 4 != 0 && is_matrix(place))
        place.fault(fmt::format("starts at byte {} of its buffer view; expected a multiple of 4, as of all matrices", offset));
    if ((offset + view.offset) % alignment != 0)
        place.fault(fmt::format("starts at byte {} of its buffer; expected a multiple of {}", offset + view.offset, alignment));
    // The last element need not be followed by the rest of a stride.
    const std::size_t room = view.bytes.size();
    if (offset > room || last_bytes > room - offset || (room - offset - last_bytes) / stride < count - 1) {
        place.fault(fmt::format("{} elements of {} bytes, {} apart, from byte {} on reach beyond buffer view {}, which has {}",
                                count, element_bytes, stride, offset, *index, room));
        return {};
    }
    return {view.bytes.data() + offset, stride};
}

Accessors::Extent Accessors::extent_of(const Accessor& a) {
    const Shape& shape = shapes().at(a.type);
    const std::size_t column = column_bytes(shape, a.component_type);
    const std::size_t number = component_bytes(a.component_type);
    return {shape.columns * column, (shape.columns - 1) * column + shape.rows * number, number};
}

void Accessors::check(std::size_t i) {
    const Element& element = document_.accessors[i];
    for (const char* name : {"componentType", "count", "type"}) element.require(name);
    const std::size_t before = document_.faults.size();
    Accessor& a = list_[i];
    a.count = static_cast<std::size_t>(element.whole("count", 0, 1, std::int64_t{1} << 32));
    a.component_type = static_cast<int>(element.whole("componentType", 5126, 0, 65535));
    a.normalized = element.flag("normalized", false);
    a.type = element.text("type", "SCALAR");
    const auto shape = shapes().find(a.type);
    if (shape == shapes().end()) element.fault("type `" + a.type + "`; expected SCALAR, VEC2, VEC3, VEC4, MAT2, MAT3 or MAT4");
    if (component_bytes(a.component_type) == 0)
        element.fault(fmt::format("component type {}; expected 5120, 5121, 5122, 5123, 5125 or 5126", a.component_type));
    if (document_.faults.size() != before || !element.present() || a.count == 0) return;
    a.components = shape->second.columns * shape->second.rows;
    if (element.has("bufferView")) {
        blocks_[i] = block(element, a.count, extent_of(a), true);
        if (blocks_[i].data == nullptr) return;
    } else if (element.has("byteOffset")) {
        element.fault("has a `byteOffset` and no `bufferView`");
        return;
    } else if (a.count > most_zeros) {
        element.fault(fmt::format("{} elements without a buffer view; expected at most {}", a.count, most_zeros));
        return;
    }
    if (element.has("sparse")) check_sparse(i);
    if (a.normalized && a.component_type > 5123) element.fault(fmt::format("`normalized` numbers of component type {}; expected integers of 8 or 16 bits", a.component_type));
    a.readable = document_.faults.size() == before;
    if (blocks_[i].data != nullptr || !sparse_[i].indices.empty()) check_values(i);
    a.readable = document_.faults.size() == before;
}

// Numbers far outside the bounds that the file states come of damage; those a rounding outside do not.
void Accessors::check_values(std::size_t i) {
    const Accessor& a = list_[i];
    const Element& element = document_.accessors[i];
    const std::vector<double> low = element.numbers("min");
    const std::vector<double> high = element.numbers("max");
    const std::size_t n = a.components;
    for (const auto* bound : {&low, &high})
        if (!bound->empty() && bound->size() != n) return element.fault(fmt::format("`min` and `max` have {} and {} numbers; expected {}", low.size(), high.size(), n));
    const bool bounded = !a.normalized && !low.empty() && !high.empty();
    if (!bounded && a.component_type != 5126) return;
    const std::vector<float> values = floats(i);
    for (std::size_t k = 0; k < values.size(); ++k) {
        const auto value = static_cast<double>(values[k]);
        if (!std::isfinite(value)) return element.fault(fmt::format("element {} is not finite", k / n), "the buffer may be damaged");
        if (!bounded) continue;
        const double least = low[k % n];
        const double most = high[k % n];
        const double slack = 0.01 * std::abs(most - least) + 1e-3 * std::max(std::abs(least), std::abs(most)) + 1e-6;
        if (value >= least - slack && value <= most + slack) continue;
        return element.fault(fmt::format("element {} has {}, outside its `min` {} and `max` {}", k / n, value, least, most), "the buffer may be damaged");
    }
}

void Accessors::check_sparse(std::size_t i) {
    const Accessor& a = list_[i];
    const Element sparse = document_.accessors[i].object("sparse");
    for (const char* name : {"count", "indices", "values"}) sparse.require(name);
    const auto count = static_cast<std::size_t>(sparse.whole("count", 0, 1, static_cast<std::int64_t>(a.count)));
    const Element where = sparse.object("indices");
    const Element what = sparse.object("values");
    where.require("bufferView");
    where.require("componentType");
    what.require("bufferView");
    const int type = static_cast<int>(where.whole("componentType", 5125, 0, 65535));
    if (type != 5121 && type != 5123 && type != 5125) {
        where.fault(fmt::format("component type {}; expected 5121, 5123 or 5125", type));
        return;
    }
    if (count == 0 || !where.has("bufferView") || !what.has("bufferView")) return;
    const std::size_t index_bytes = component_bytes(type);
    const Block indices = block(where, count, {index_bytes, index_bytes, index_bytes}, false);
    const Block values = block(what, count, extent_of(a), false);
    if (indices.data == nullptr || values.data == nullptr) return;
    Sparse& out = sparse_[i];
    out.values = values;
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t index = integer_at(indices.data + k * indices.stride, type, false);
        if (index >= a.count || (k > 0 && index <= out.indices.back())) {
            where.fault(fmt::format("index {} is {}; expected ascending ones below {}", k, index, a.count));
            return;
        }
        out.indices.push_back(index);
    }
}

template <class Out, class Convert>
void Accessors::read(std::size_t i, std::vector<Out>& out, Convert convert) const {
    const Accessor& a = list_[i];
    const Shape& shape = shapes().at(a.type);
    const std::size_t size = component_bytes(a.component_type);
    const std::size_t column_step = column_bytes(shape, a.component_type);
    const auto put = [&](std::size_t element, const char* data) {
        Out* to = out.data() + element * a.components;
        for (std::size_t column = 0; column < shape.columns; ++column)
            for (std::size_t row = 0; row < shape.rows; ++row)
                *to++ = convert(data + column * column_step + row * size, a.component_type, a.normalized);
    };
    const Block& block = blocks_[i];
    if (block.data != nullptr)
        for (std::size_t k = 0; k < a.count; ++k) put(k, block.data + k * block.stride);
    const Sparse& sparse = sparse_[i];
    for (std::size_t k = 0; k < sparse.indices.size(); ++k)
        put(sparse.indices[k], sparse.values.data + k * sparse.values.stride);
}

void Accessors::refuse_stride(const Element& owner, const char* name) const {
    const auto index = owner.index(name, size(), "accessors");
    if (!index) return;
    const auto view = document_.accessors[*index].index("bufferView", document_.views.size(), "buffer views");
    if (view && document_.views[*view].stride > 0)
        owner.fault(fmt::format("`{}` is accessor {} in buffer view {}, which has a `byteStride`; only vertices may have one", name, *index, *view));
}

std::vector<float> Accessors::floats(std::size_t i) const {
    std::vector<float> out;
    if (!list_[i].readable) return out;
    out.resize(list_[i].count * list_[i].components);
    read(i, out, float_at);
    return out;
}

std::vector<std::uint32_t> Accessors::integers(std::size_t i) const {
    std::vector<std::uint32_t> out;
    if (!list_[i].readable) return out;
    const int type = list_[i].component_type;
    if (type != 5121 && type != 5123 && type != 5125) {
        document_.accessors[i].fault(fmt::format("component type {}; expected unsigned integers: 5121, 5123 or 5125", type));
        return out;
    }
    out.resize(list_[i].count * list_[i].components);
    read(i, out, integer_at);
    return out;
}

}  // namespace wavelobe::gltf
