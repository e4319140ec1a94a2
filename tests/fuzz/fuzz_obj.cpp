#include "fuzz_file.h"
#include "scene/mesh.h"

using namespace wavelobe;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string path = fuzz::write_file(fuzz::content_of(data, size), ".obj");
    return fuzz::refuse_or_read([&] { prepare_mesh(load_obj(path, true), {}); });
}
