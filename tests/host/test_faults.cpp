// What is refused, where, and in which words.
#include <gtest/gtest.h>

#include <algorithm>

#include "host/scene_files.h"
#include "scene/supported.h"

namespace wavelobe::test {
namespace {

// The only fault of the elements, which start on line 2.
Fault only_fault(const std::string& xml) {
    const std::vector<Fault> faults = SceneFolder().element_faults(xml);
    EXPECT_EQ(faults.size(), 1U) << xml << "\n" << texts(faults);
    return faults.empty() ? Fault{} : faults[0];
}

void expect_fault(const std::string& xml, const std::string& text) {
    const Fault fault = only_fault(xml);
    EXPECT_NE(fault.text().find(text), std::string::npos) << fault.text();
}

TEST(Faults, AllOfAFileAtOnceWithTheirPlaces) {
    const SceneFolder folder;
    const auto faults = folder.element_faults(
        "<bsdf type=\"hair\"/>\n"
        "  <shape type=\"sphere\">\n"
        "    <float name=\"radius\" value=\"wide\"/>\n"
        "    <float name=\"raduis\" value=\"1\"/>\n"
        "    <ref id=\"nothing\"/>\n"
        "  </shape>\n"
        "<emitter type=\"sun\"/>");
    std::vector<std::string> places;
    for (const Fault& fault : faults) {
        EXPECT_EQ(fault.file, folder.path("scene.xml"));
        places.push_back(std::to_string(fault.line) + ":" + std::to_string(fault.column));
    }
    std::sort(places.begin(), places.end());
    EXPECT_EQ(places, (std::vector<std::string>{"2:1", "4:5", "5:5", "6:5", "8:1"})) << texts(faults);
    EXPECT_TRUE(has_text(faults, "`conductor`, `dielectric`"));
    EXPECT_TRUE(has_text(faults, "did you mean `radius`?"));
}

TEST(Faults, XmlThatIsNotWellFormed) {
    const SceneFolder folder;
    const auto faults = folder.faults("<scene version=\"3.0.0\">\n  <shape type=\"sphere\">\n</scene>\n");
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].line, 3);
    EXPECT_NE(faults[0].message.find("not well-formed"), std::string::npos);
    EXPECT_EQ(folder.faults("").size(), 1U);
    EXPECT_EQ(folder.faults("<bsdf version=\"3.0.0\" type=\"diffuse\"/>").size(), 1U);
}

TEST(Faults, MissingSceneFile) { EXPECT_THROW(read_mitsuba_scene(SceneFolder().path("absent.xml")), InputError); }

TEST(Faults, Versions) {
    const SceneFolder folder;
    const auto faults = [&](const std::string& attribute) {
        return folder.faults("<scene" + attribute + "><sensor type=\"perspective\"/></scene>");
    };
    EXPECT_TRUE(faults(" version=\"3.9.1\"").empty());
    EXPECT_TRUE(faults(" version=\"2.1.0\"").empty());
    EXPECT_TRUE(has_text(faults(""), "`version` is missing"));
    EXPECT_TRUE(faults(" version=\"0.6.0\"").empty());
    EXPECT_TRUE(has_text(faults(" version=\"3.0\""), "three numbers"));
    EXPECT_TRUE(has_text(faults(" version=\"new\""), "three numbers"));
}

TEST(Faults, Substitution) {
    const Fault fault = only_fault("<shape type=\"sphere\"><float name=\"radius\" value=\"$r\"/></shape>");
    EXPECT_NE(fault.message.find("$r is not defined"), std::string::npos);
    EXPECT_EQ(fault.column, 22);
    EXPECT_TRUE(has_text(SceneFolder().faults(SceneFolder::wrap(""), {{"spp", "4"}}), "-D spp"));
}

TEST(Faults, Values) {
    const auto radius = [](const std::string& value) {
        return "<shape type=\"sphere\"><float name=\"radius\" value=\"" + value + "\"/></shape>";
    };
    for (const char* value : {"", "1,5", "nan", "inf", "1e999", "0x10", "1 2"})
        expect_fault(radius(value), "expected a finite number");
    expect_fault("<integrator type=\"path\"><integer name=\"max_depth\" value=\"1.5\"/></integrator>",
                 "a whole number");
    expect_fault("<integrator type=\"path\"><integer name=\"max_depth\" value=\"-2\"/></integrator>", "from -1 to");
    expect_fault("<integrator type=\"path\"><integer name=\"rr_depth\" value=\"0\"/></integrator>", "from 1 to");
    expect_fault("<integrator type=\"path\"><float name=\"max_depth\" value=\"2\"/></integrator>",
                 "give it as <integer>");
    expect_fault("<integrator type=\"path\"><boolean name=\"hide_emitters\" value=\"yes\"/></integrator>",
                 "`true` or `false`");
    expect_fault("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"1, 2\"/></bsdf>", "one or three");
    expect_fault("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0, 0, 1.5\"/></bsdf>", "from 0 to 1");
    expect_fault("<bsdf type=\"conductor\"><string name=\"material\" value=\"au\"/></bsdf>", "did you mean `Au`?");
    expect_fault("<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"watre\"/></bsdf>",
                 "did you mean `water`?");
    expect_fault("<emitter type=\"point\"><rgb name=\"intensity\" value=\"-1\"/></emitter>", "not negative");
    expect_fault("<emitter type=\"directional\"><vector name=\"direction\" value=\"0, 0, 0\"/></emitter>", "zero");
    expect_fault("<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"2\"/></shape>", "`z` is missing");
}

TEST(Faults, Transforms) {
    const auto transform = [](const std::string& inside) {
        return "<shape type=\"disk\"><transform name=\"to_world\">" + inside + "</transform></shape>";
    };
    expect_fault(transform("<rotate angle=\"3\"/>"), "axis is zero");
    expect_fault(transform("<matrix value=\"1 2 3\"/>"), "9 or 16");
    expect_fault(transform("<lookat origin=\"0,0,0\" target=\"0,1,0\" up=\"0,1,0\"/>"), "parallel");
    expect_fault(transform("<skew x=\"1\"/>"), "not an operation");
    expect_fault(transform("<scale value=\"1\" x=\"2\"/>"), "cannot be combined");
    expect_fault(transform("<scale x=\"0\"/>"), "not an invertible");
    expect_fault(transform("<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1\"/>"), "not an invertible");
    expect_fault("<shape type=\"sphere\"><transform name=\"to_world\"><scale x=\"2\"/></transform></shape>",
                 "unevenly");
    expect_fault("<shape type=\"cylinder\"><transform name=\"to_world\"><scale x=\"2\"/></transform></shape>",
                 "unevenly");
    expect_fault(
        "<sensor type=\"perspective\"><transform name=\"to_world\"><scale value=\"2\"/></transform></sensor>",
        "cannot scale");
    expect_fault("<scale value=\"2\"/>", "only a <transform>");
}

TEST(Faults, Structure) {
    expect_fault("<shpae type=\"sphere\"/>", "did you mean `shape`?");
    expect_fault("<shape type=\"sphere\" name=\"a\" colour=\"red\"/>", "unexpected attribute `colour`");
    expect_fault("<shape/>", "`type` is missing");
    expect_fault(
        "<shape type=\"sphere\"><float name=\"radius\" value=\"1\"/><float name=\"radius\" value=\"2\"/></shape>",
        "more than once");
    expect_fault("<shape type=\"sphere\" id=\"a\"/><bsdf type=\"diffuse\" id=\"a\"/>", "is taken by line 2");
    expect_fault("<shape type=\"sphere\"><bsdf type=\"diffuse\"/><bsdf type=\"diffuse\"/></shape>",
                 "more than one bsdf");
    expect_fault("<shape type=\"sphere\"><texture type=\"checkerboard\" name=\"colour\"/></shape>",
                 "cannot hold a nested texture");
    expect_fault("<bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\"/><texture type=\"bitmap\" name=\"reflectance\"/></bsdf>",
                 "more than one object named `reflectance`");
    expect_fault("<shape type=\"sphere\"><float name=\"radius\" value=\"1\"><scale/></float></shape>",
                 "cannot be nested");
    expect_fault("<bsdf type=\"twosided\"/>", "holds 0 nested");
    expect_fault("<bsdf type=\"twosided\"><bsdf type=\"dielectric\"/></bsdf>", "transmits light");
    expect_fault("<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>", "refers back");
    expect_fault("<emitter type=\"area\"/>", "needs a shape");
    expect_fault("<shape type=\"disk\"><emitter type=\"point\"/></shape>", "only an `area`");
    expect_fault("<emitter type=\"constant\"/><emitter type=\"constant\"/>", "has a `constant` or `envmap`");
    expect_fault("<integrator type=\"path\"/><integrator type=\"path\"/>", "has an integrator");
    expect_fault("<shape type=\"sphere\"><ref id=\"\"/></shape>", "the id is empty");
    expect_fault("<alias id=\"a\" as=\"b\"/>", "no object before this line");
    expect_fault("<shape type=\"obj\"/>", "`filename` is missing");
    expect_fault("<shape type=\"obj\"><string name=\"filename\" value=\"absent.obj\"/></shape>", "does not exist");
    expect_fault("<emitter type=\"constant\"><texture type=\"checkerboard\" name=\"radiance\"/></emitter>",
                 "cannot vary");
    expect_fault("<shape type=\"sphere\"><medium type=\"homogeneous\" name=\"interior\"/></shape>", "scattering media are not supported");
    expect_fault("<float name=\"gamma\" value=\"1\"/>", "unknown property `gamma`");
}

TEST(Faults, OfWhatNothingRefersTo) {
    for (const char* tag : {"sampler", "rfilter", "medium", "phase", "volume"})
        expect_fault("<" + std::string(tag) + " type=\"sphere\"/>", "this type of " + std::string(tag) + " is not supported");
    EXPECT_TRUE(SceneFolder().element_faults("<medium type=\"heterogeneous\"/><phase type=\"hg\"/><rfilter type=\"tent\"/>").empty());
}

TEST(Faults, SensorIsNeeded) {
    EXPECT_TRUE(has_text(SceneFolder().faults("<scene version=\"3.0.0\"/>"), "no sensor"));
}

TEST(Faults, IncludeLoopsAndAbsentIncludes) {
    const SceneFolder folder;
    folder.write("a.xml", "<scene version=\"3.0.0\">\n<include filename=\"b.xml\"/></scene>");
    folder.write("b.xml", "<scene version=\"3.0.0\">\n\n  <include filename=\"a.xml\"/></scene>");
    const auto faults = folder.element_faults("<include filename=\"a.xml\"/><include filename=\"c.xml\"/>");
    ASSERT_EQ(faults.size(), 2U) << texts(faults);
    EXPECT_EQ(faults[0].file, folder.path("b.xml"));
    EXPECT_EQ(faults[0].line, 3);
    EXPECT_EQ(faults[0].column, 3);
    EXPECT_NE(faults[0].message.find("includes itself"), std::string::npos);
    EXPECT_NE(faults[1].message.find("`c.xml` does not exist"), std::string::npos);
}

TEST(Faults, OfMeshFilesNameTheFileAndTheShape) {
    const SceneFolder folder;
    folder.write("m.obj", "v 0 0 0\nf 1 2 3\n");
    const auto faults = folder.element_faults(
        "<shape type=\"obj\" id=\"chair\"><string name=\"filename\" value=\"m.obj\"/></shape>");
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].file, folder.path("m.obj"));
    EXPECT_EQ(faults[0].line, 2);
    EXPECT_NE(faults[0].hint.find("scene.xml:2 by shape[obj] \"chair\""), std::string::npos);
}

TEST(Faults, SupportedListsAreComplete) {
    for (const SupportedPlugins& kind : supported_plugins()) {
        EXPECT_FALSE(kind.types.empty()) << kind.kind;
        EXPECT_TRUE(std::is_sorted(kind.types.begin(), kind.types.end())) << kind.kind;
    }
}

}  // namespace
}  // namespace wavelobe::test
