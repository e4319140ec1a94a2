// Spectra and their colours.
#include <gtest/gtest.h>

#include "host/scene_files.h"
#include "scene/spectrum.h"

namespace wavelobe::test {
namespace {

void expect_colour(const glm::dvec3& found, const glm::dvec3& expected, double tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << "component " << i;
}

// Values of Mitsuba 3.9.1 (spectrum_list_to_srgb), which sums a thousand terms in single precision: they are good to five
// digits.
TEST(Spectra, ColoursOfSampledSpectra) {
    const SampledSpectrum orange{{400, 500, 600, 700}, {0.1, 0.2, 0.9, 0.3}};
    expect_colour(spectrum_to_rgb(orange, Illuminant::d65), {0.935471, 0.498116, 0.100384}, 1e-5);
    const SampledSpectrum light{{400, 500, 600, 700}, {1, 2, 9, 3}};
    expect_colour(spectrum_to_rgb(light, Illuminant::none), {10.6947, 4.81563, 0.834411}, 1e-4);
    const SampledSpectrum white{{360, 830}, {1, 1}};
    expect_colour(spectrum_to_rgb(white, Illuminant::d65), {0.998983, 0.998872, 0.998802}, 1e-5);
    expect_colour(spectrum_to_rgb(blackbody(3000.0), Illuminant::none), {733.111, 349.57, 112.711}, 2e-3);
}

TEST(Spectra, Files) {
    const SceneFolder folder;
    const SampledSpectrum read = load_spd(folder.write("a.spd", "# comment\n400 0.1\r\n\n500\t2e-1 # more\n  600 0.9"));
    EXPECT_EQ(read.wavelengths, (std::vector<double>{400, 500, 600}));
    EXPECT_EQ(read.values, (std::vector<double>{0.1, 0.2, 0.9}));
    for (const char* bad : {"", "400 1", "400 1\n300 2", "400 1\n500", "400 1\n500 x", "400 nan\n500 1", "400 1 2\n500 1"})
        EXPECT_THROW(load_spd(folder.write("b.spd", bad)), InputError) << bad;
}

TEST(Spectra, PropertiesAndPluginsAgree) {
    const SceneFolder folder;
    folder.write("a.spd", "400 0.1\n500 0.2\n600 0.9\n700 0.3\n");
    const auto reflectance = [&](const std::string& xml) {
        const Scene scene = folder.elements("<shape type=\"sphere\"><bsdf type=\"diffuse\">" + xml + "</bsdf></shape>");
        return std::get<Diffuse>(scene.materials.at(0).model).reflectance.value;
    };
    const Rgb pairs = reflectance(R"(<spectrum name="reflectance" value="400:0.1, 500:0.2 600:0.9, 700:0.3"/>)");
    EXPECT_NEAR(pairs.r, 0.935471F, 1e-5F);
    EXPECT_EQ(reflectance(R"(<spectrum name="reflectance" filename="a.spd"/>)"), pairs);
    EXPECT_EQ(reflectance(R"(<spectrum type="irregular" name="reflectance"><string name="wavelengths" value="400, 500, 600, 700"/>
        <string name="values" value="0.1, 0.2, 0.9, 0.3"/></spectrum>)"), pairs);
    EXPECT_EQ(reflectance(R"(<spectrum type="regular" name="reflectance"><float name="wavelength_min" value="400"/>
        <float name="wavelength_max" value="700"/><string name="values" value="0.1, 0.2, 0.9, 0.3"/></spectrum>)"), pairs);
    EXPECT_EQ(reflectance(R"(<texture type="uniform" name="reflectance"><float name="value" value="0.25"/></texture>)"), Rgb(0.25F));
    // Saturated spectra leave the gamut; reflectances are clamped into it.
    EXPECT_EQ(reflectance(R"(<spectrum name="reflectance" value="600:1, 700:1"/>)").b, 0.0F);
    const Scene lamp = folder.elements(R"(<emitter type="constant"><spectrum type="d65" name="radiance">
        <float name="scale" value="3"/></spectrum></emitter>)");
    EXPECT_EQ(std::get<ConstantEmitter>(lamp.emitters.at(0)).radiance, Rgb(3.0F));
    const Scene bulb = folder.elements(R"(<emitter type="point"><spectrum type="blackbody" name="intensity">
        <float name="temperature" value="3000"/></spectrum></emitter>)");
    EXPECT_NEAR(std::get<PointEmitter>(bulb.emitters.at(0)).intensity.r, 733.111F, 2e-3F);
}

TEST(Spectra, Faults) {
    const SceneFolder folder;
    const auto refused = [&](const std::string& xml, const std::string& text) {
        const auto faults = folder.element_faults("<bsdf type=\"diffuse\">" + xml + "</bsdf>");
        EXPECT_EQ(faults.size(), 1U) << xml << "\n" << texts(faults);
        EXPECT_TRUE(has_text(faults, text)) << texts(faults);
    };
    refused(R"(<spectrum name="reflectance" value="400:1 500"/>)", "a pair wavelength:value");
    refused(R"(<spectrum name="reflectance" value="400:1"/>)", "at least two wavelengths");
    refused(R"(<spectrum name="reflectance" value="500:1, 400:1"/>)", "increase");
    refused(R"(<spectrum name="reflectance" value="0.1, 0.2, 0.3"/>)", "one finite number, or pairs");
    refused(R"(<spectrum name="reflectance" filename="none.spd"/>)", "`none.spd` does not exist");
    refused(R"(<spectrum type="blackbody" name="reflectance"/>)", "`temperature` is missing");
    refused(R"(<spectrum type="irregular" name="reflectance"><string name="wavelengths" value="400, 500"/>
        <string name="values" value="1, 2, 3"/></spectrum>)", "as many values");
}

}  // namespace
}  // namespace wavelobe::test
