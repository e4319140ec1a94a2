#include "fuzz_file.h"
#include "scene/image.h"

using namespace wavelobe;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string path = fuzz::write_file(fuzz::content_of(data, size), ".exr");
    return fuzz::refuse_or_read([&] { load_image(path, Transfer::of_format); });
}
