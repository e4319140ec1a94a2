// Scenes that are small as files and would be without measure when read: each ends soon, with a fault.
#include <gtest/gtest.h>

#include "host/scene_files.h"

namespace wavelobe::test {
namespace {

constexpr int many = 20000;

std::string repeat(const std::string& text) {
    std::string all;
    for (int i = 0; i < many; ++i) all += text;
    return all;
}

std::string sided(int id, int inner) {
    return "<bsdf type=\"twosided\" id=\"b" + std::to_string(id) + "\"><ref id=\"b" + std::to_string(inner) + "\"/></bsdf>\n";
}

TEST(ReaderLimits, ChainsOfReferences) {
    std::string forward, backward;
    for (int i = 0; i < many; ++i) {
        forward += sided(i, i + 1);
        backward += sided(many - 1 - i, many - i);
    }
    const std::string end = "<bsdf type=\"diffuse\" id=\"b" + std::to_string(many) + "\"/>";
    for (const std::string& xml : {forward + end, end + backward, forward + sided(many, 0)})
        EXPECT_TRUE(has_text(SceneFolder().element_faults(xml), "nested more than"));
}

TEST(ReaderLimits, DeepNesting) {
    EXPECT_TRUE(has_text(SceneFolder().element_faults("<shape type=\"sphere\">" + repeat("<bsdf type=\"twosided\">") + repeat("</bsdf>") + "</shape>"),
                         "nested more than"));
    EXPECT_TRUE(has_text(SceneFolder().element_faults(repeat("<a>") + repeat("</a>")), "unknown element"));
}

TEST(ReaderLimits, MoreFaultsThanAnyoneReads) {
    std::string shapes;
    for (int i = 0; i < many; ++i) shapes += "<shape type=\"sphere\"><ref id=\"absent" + std::to_string(i) + "\"/></shape>\n";
    const std::vector<Fault> faults = SceneFolder().element_faults(shapes);
    EXPECT_EQ(faults.size(), 1001U);
    EXPECT_TRUE(has_text(faults, "has more faults than these 1000"));
}

TEST(ReaderLimits, PropertiesOfOneObject) {
    std::string properties;
    for (int i = 0; i < many; ++i) properties += "<float name=\"p" + std::to_string(i) + "\" value=\"1\"/>\n";
    EXPECT_TRUE(has_text(SceneFolder().element_faults("<shape type=\"sphere\">" + properties + "</shape>"), "more than 256 properties"));
}

TEST(ReaderLimits, ParametersThatGrow) {
    std::string xml = "<default name=\"a0\" value=\"ten letters\"/>";
    for (int i = 1; i < 12; ++i) {
        xml += "<default name=\"a" + std::to_string(i) + "\" value=\"";
        for (int k = 0; k < 10; ++k) xml += "$a" + std::to_string(i - 1);
        xml += "\"/>";
    }
    EXPECT_TRUE(has_text(SceneFolder().element_faults(xml), "grow beyond 64 MiB"));
}

TEST(ReaderLimits, IncludesThatMultiply) {
    const SceneFolder folder;
    for (int i = 0; i < 10; ++i) {
        std::string twenty;
        for (int k = 0; k < 20; ++k) twenty += "<include filename=\"" + std::to_string(i + 1) + ".xml\"/>";
        folder.write(std::to_string(i) + ".xml", "<scene version=\"3.0.0\">" + twenty + "</scene>");
    }
    folder.write("10.xml", "<scene version=\"3.0.0\"/>");
    EXPECT_TRUE(has_text(folder.element_faults("<include filename=\"0.xml\"/>"), "more than 10000 files"));
}

}  // namespace
}  // namespace wavelobe::test
