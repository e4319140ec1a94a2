// PNG, JPEG, Radiance HDR, PFM, PPM, BMP and, by its name, TGA.
#include "fuzz_file.h"
#include "scene/image.h"

using namespace wavelobe;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string content = fuzz::content_of(data, size);
    fuzz::refuse_or_read([&] { decode_image("input", content, Transfer::of_format); });
    return fuzz::refuse_or_read([&] { decode_image("input.tga", content, Transfer::alpha); });
}
