// Shape groups and instances of Mitsuba scenes.
#include <gtest/gtest.h>

#include "host/scene_files.h"

namespace wavelobe::test {
namespace {

const std::string group = R"(<shape type="shapegroup" id="g"><shape type="cube"/><shape type="sphere" id="ball"/></shape>)";

TEST(ShapeGroups, AreReadOnceAndPlacedByInstances) {
    const Scene scene = SceneFolder().elements(group + R"(
        <shape type="instance"><ref id="g"/></shape>
        <shape type="instance"><ref id="g"/><transform name="to_world"><scale x="-2"/><translate y="3"/></transform></shape>
        <shape type="disk"/>)");
    ASSERT_EQ(scene.groups.size(), 1U);
    EXPECT_EQ(scene.groups[0].name, "g");
    ASSERT_EQ(scene.groups[0].shapes.size(), 2U);
    EXPECT_EQ(scene.groups[0].shapes[1].name, "ball");
    EXPECT_EQ(scene.shapes.size(), 1U);  // what is in a group is not seen by itself
    ASSERT_EQ(scene.instances.size(), 2U);
    EXPECT_EQ(scene.instances[0].to_world, glm::mat4(1.0F));
    EXPECT_EQ(scene.instances[1].to_world[0], glm::vec4(-2, 0, 0, 0));
    EXPECT_EQ(scene.instances[1].to_world[3], glm::vec4(0, 3, 0, 1));
}

TEST(ShapeGroups, MayFollowTheirInstances) {
    const Scene scene = SceneFolder().elements(R"(<shape type="instance"><ref id="g"/></shape>)" + group);
    EXPECT_EQ(scene.groups.size(), 1U);
    EXPECT_EQ(scene.instances.size(), 1U);
}

TEST(ShapeGroups, MergedShapesAreTheShapesThemselves) {
    const Scene scene = SceneFolder().elements(R"(<shape type="merge"><shape type="cube" id="a"/>
            <shape type="merge"><shape type="disk" id="b"><emitter type="area"/></shape></shape></shape>
        <shape type="shapegroup" id="g"><shape type="merge"><shape type="cube"/><shape type="sphere"/></shape></shape>
        <shape type="instance"><ref id="g"/></shape>)");
    ASSERT_EQ(scene.shapes.size(), 2U);
    EXPECT_EQ(scene.shapes[0].name, "a");
    EXPECT_EQ(scene.shapes[1].name, "b");
    EXPECT_TRUE(scene.shapes[1].emitter.has_value());
    ASSERT_EQ(scene.groups.size(), 1U);
    EXPECT_EQ(scene.groups[0].shapes.size(), 2U);
    EXPECT_TRUE(has_text(SceneFolder().element_faults(R"(<shape type="merge"><bsdf type="diffuse"/></shape>)"), "bsdf"));
}

TEST(ShapeGroups, Faults) {
    const auto faults = [](const std::string& xml) { return SceneFolder().element_faults(xml); };
    EXPECT_TRUE(has_text(faults(R"(<shape type="instance"/>)"), "holds 0 shapes; expected one shapegroup"));
    EXPECT_TRUE(has_text(faults(R"(<shape type="instance"><shape type="cube"/></shape>)"),
                         "holds a cube; expected one shapegroup"));
    EXPECT_TRUE(has_text(faults(group + R"(<shape type="instance"><ref id="g"/><bsdf type="diffuse"/></shape>)"), "bsdf"));
    EXPECT_TRUE(has_text(faults(group + R"(<shape type="instance"><ref id="g"/>
                                <transform name="to_world"><scale x="0"/></transform></shape>)"),
                         "not an invertible affine transform"));
    const std::string nested = R"(<shape type="shapegroup">)" ;
    EXPECT_TRUE(has_text(faults(group + nested + R"(<shape type="instance"><ref id="g"/></shape></shape>)"),
                         "instances do not nest: a shapegroup cannot hold instances"));
    EXPECT_TRUE(has_text(faults(nested + R"(<shape type="shapegroup"/></shape>)"), "a shapegroup cannot hold shapegroups"));
    EXPECT_TRUE(has_text(faults(nested + R"(<shape type="sphere"><emitter type="area"/></shape></shape>)"),
                         "a shape in a shapegroup cannot hold an emitter or sensor"));
}

}  // namespace
}  // namespace wavelobe::test
