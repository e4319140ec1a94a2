// Files of wavelengths and values, by a scene that names one.
#include "fuzz_file.h"
#include "scene/mitsuba_reader.h"

using namespace wavelobe;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::write_file(fuzz::content_of(data, size), ".spd");
    static const std::string scene = fuzz::write_file(R"(<scene version="3.0.0"><sensor type="perspective"/><shape type="sphere">
        <bsdf type="diffuse"><spectrum name="reflectance" filename="input.spd"/></bsdf></shape></scene>)", ".xml");
    return fuzz::refuse_or_read([&] { read_mitsuba_scene(scene, {}); });
}
