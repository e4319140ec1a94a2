// The media of Mitsuba scenes: which shapes part which, and what is refused.
#include <gtest/gtest.h>

#include "host/scene_files.h"

namespace wavelobe::test {
namespace {

constexpr const char* volpath = R"(<integrator type="volpath"/>)";
constexpr const char* fog = R"(<medium type="homogeneous" id="fog"><float name="albedo" value="0"/>
    <rgb name="sigma_t" value="0.5, 0.2, 0.4"/><float name="scale" value="2"/></medium>)";
constexpr const char* haze = R"(<medium type="homogeneous" id="haze"><rgb name="albedo" value="0, 0, 0"/></medium>)";

std::string with(const std::string& elements) { return std::string(volpath) + fog + haze + elements; }

TEST(MitsubaMedia, SidesOfShapes) {
    const Scene scene = SceneFolder().elements(with(R"(
        <shape type="sphere"><bsdf type="null"/><ref name="interior" id="fog"/></shape>
        <shape type="sphere"><bsdf type="dielectric"/><ref name="exterior" id="fog"/><ref name="interior" id="haze"/></shape>
        <shape type="sphere"/>)"));
    ASSERT_EQ(scene.shapes.size(), 3U);
    ASSERT_EQ(scene.media.size(), 2U);
    EXPECT_EQ(scene.media[0].absorption, Rgb(1.0F, 0.4F, 0.8F));
    EXPECT_EQ(scene.media[1].absorption, Rgb(1.0F));
    ASSERT_TRUE(scene.shapes[0].media);
    EXPECT_EQ(scene.shapes[0].media->interior, 0);
    EXPECT_EQ(scene.shapes[0].media->exterior, -1);
    ASSERT_TRUE(scene.shapes[1].media);
    EXPECT_EQ(scene.shapes[1].media->interior, 1);
    EXPECT_EQ(scene.shapes[1].media->exterior, 0);
    EXPECT_FALSE(scene.shapes[2].media);
    EXPECT_EQ(scene.camera_medium, -1);
}

TEST(MitsubaMedia, ConstantVolumesAndNestedMedia) {
    const Scene scene = SceneFolder().elements(std::string(volpath) + R"(<shape type="sphere">
        <medium type="homogeneous" name="interior">
            <volume type="constvolume" name="albedo"><float name="value" value="0"/></volume>
            <volume type="constvolume" name="sigma_t"><rgb name="value" value="2, 1, 0"/></volume>
            <phase type="hg"><float name="g" value="0.7"/></phase> <boolean name="sample_emitters" value="false"/>
        </medium></shape>)");
    ASSERT_EQ(scene.media.size(), 1U);
    EXPECT_EQ(scene.media[0].absorption, Rgb(2.0F, 1.0F, 0.0F));
}

// Mitsuba's `path` sees no media.
TEST(MitsubaMedia, OfAnIntegratorThatSeesNone) {
    const Scene scene = SceneFolder().elements(std::string(R"(<integrator type="path"/>)") + fog +
                                               R"(<shape type="sphere"><bsdf type="null"/><ref name="interior" id="fog"/></shape>)");
    EXPECT_TRUE(scene.media.empty());
    ASSERT_EQ(scene.shapes.size(), 1U);
    EXPECT_FALSE(scene.shapes[0].media);
    ASSERT_FALSE(scene.warnings.empty());
    EXPECT_NE(scene.warnings[0].find("integrator"), std::string::npos);
}

struct Refused {
    const char* name;
    const char* elements;
    const char* message;  // part of the only fault
};
void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name; }
class RefusedMedia : public testing::TestWithParam<Refused> {};

TEST_P(RefusedMedia, ByNameAndPlace) {
    const auto faults = SceneFolder().element_faults(with(GetParam().elements));
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_NE(faults[0].message.find(GetParam().message), std::string::npos) << faults[0].message;
    EXPECT_GT(faults[0].line, 0);
    EXPECT_GT(faults[0].column, 0);
}

INSTANTIATE_TEST_SUITE_P(
    All, RefusedMedia,
    testing::Values(
        Refused{"scattering", R"(<shape type="cube"><medium type="homogeneous" name="interior"><float name="albedo" value="0.5"/></medium></shape>)", "scattering media"},
        Refused{"scattering_by_default", R"(<shape type="cube"><medium type="homogeneous" name="interior"/></shape>)", "0.75 by default"},
        Refused{"heterogeneous", R"(<shape type="cube"><medium type="heterogeneous" name="interior"/></shape>)", "vary in space"},
        Refused{"grid", R"(<shape type="cube"><medium type="homogeneous" name="interior"><float name="albedo" value="0"/>
            <volume type="gridvolume" name="sigma_t"><string name="filename" value="a.vol"/></volume></medium></shape>)", "vary in space"},
        Refused{"no_side", R"(<shape type="cube"><ref id="fog"/></shape>)", "interior"},
        Refused{"twice", R"(<shape type="cube"><ref name="interior" id="fog"/><ref name="interior" id="haze"/></shape>)", "more than one"},
        Refused{"negative", R"(<shape type="cube"><medium type="homogeneous" name="interior"><float name="albedo" value="0"/>
            <float name="sigma_t" value="-1"/></medium></shape>)", "not negative"},
        Refused{"mask", R"(<shape type="cube"><bsdf type="mask"><bsdf type="diffuse"/></bsdf><ref name="interior" id="fog"/></shape>)", "mask"}),
    [](const auto& refused) { return refused.param.name; });

}  // namespace
}  // namespace wavelobe::test
