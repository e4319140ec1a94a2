#include "fuzz_file.h"
#include "scene/mitsuba_reader.h"

using namespace wavelobe;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string path = fuzz::write_file(fuzz::content_of(data, size), ".xml");
    return fuzz::refuse_or_read([&] { read_mitsuba_scene(path, {}); });
}
