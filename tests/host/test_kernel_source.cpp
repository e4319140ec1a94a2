// One source for the OpenCL compiler: every include replaced.
#include <gtest/gtest.h>

#include "cl/kernel_source.h"

namespace wavelobe {
namespace {

std::size_t count(const std::string& text, std::string_view what) {
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
}

constexpr std::string_view lanes_guard = "#define WAVELOBE_CORE_LANES_H";

TEST(KernelSource, LeavesNoInclude) {
    for (const KernelFile& file : embedded_kernel_files()) {
        EXPECT_EQ(count(flatten_includes(file.text, file.path), "\n#include \""), 0U) << file.path;
    }
}

TEST(KernelSource, AFileComesOnce) {
    const std::string text = flatten_includes("#include \"core/vector.h\"\n#include \"core/lanes.h\"\n", "test.cl");
    EXPECT_EQ(count(text, lanes_guard), 1U);
}

// What a condition may remove does not count as included.
TEST(KernelSource, AFileUnderAConditionComesAgain) {
    const std::string text =
        flatten_includes("#if 0\n#include \"core/lanes.h\"\n#endif\n#include \"core/lanes.h\"\n", "test.cl");
    EXPECT_EQ(count(text, lanes_guard), 2U);
}

TEST(KernelSource, CompilersAreToldThePlace) {
    const std::string text = flatten_includes("first\n#include \"core/lanes.h\"\nthird\n", "test.cl");
    EXPECT_EQ(text.rfind("#line 1 \"test.cl\"\nfirst\n", 0), 0U);
    EXPECT_NE(text.find("#line 3 \"test.cl\"\nthird\n"), std::string::npos);
    EXPECT_NE(text.find("#line 1 \"core/lanes.h\"\n"), std::string::npos);
}

TEST(KernelSource, AMissingFileIsNamed) {
    try {
        flatten_includes("#include \"core/nothing.h\"\n", "test.cl");
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("core/nothing.h"), std::string::npos);
    }
}

}  // namespace
}  // namespace wavelobe
