// The file as it is, and its bytes as what a compressed stream holds: damage to that would otherwise end at its checksum.
#include <vector>

#include <zlib.h>

#include "fuzz_file.h"
#include "scene/mesh.h"

using namespace wavelobe;

namespace {

std::string compressed(const std::uint8_t* data, std::size_t size) {
    std::vector<Bytef> out(compressBound(size));
    uLongf length = out.size();
    if (compress(out.data(), &length, data, size) != Z_OK) std::abort();
    return std::string("\x1c\x04\x04\x00", 4) + std::string(reinterpret_cast<const char*>(out.data()), length);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    for (const std::string& content : {fuzz::content_of(data, size), compressed(data, size)}) {
        const std::string path = fuzz::write_file(content, ".serialized");
        for (const std::uint32_t index : {0U, 1U}) fuzz::refuse_or_read([&] { prepare_mesh(load_serialized(path, index), {}); });
    }
    return 0;
}
