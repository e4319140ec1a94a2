// No small constant in the kernels but those that say what they bound: nothing is fudged by a fixed distance.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace wavelobe {
namespace {

namespace fs = std::filesystem;

struct Known {
    const char* file;
    const char* text;  // of the line
    const char* why;
};

// None of these is a length in a scene, or an angle that something is moved by.
const std::vector<Known> known_constants{
    {"core/rounding.h", "#define HALF_ULP 5.96", "relative error of one rounding"},
    {"sampling/sampler.h", "convert_Float(as_Int(bits >> 8)) * 5.96", "24 bits as a fraction"},
    {"bsdf/microfacet.h", "#define MIN_ALPHA 1e-4f", "narrowest lobe that float directions hold"},
    {"bsdf/fresnel.h", "GREATER(sum, (Float)1e-30f)", "divisor of a quotient that is not selected"},
    {"bsdf/principled_parameters.h", "#define LEAST_PRINCIPLED_ALPHA 1e-3f", "narrowest slopes, as Mitsuba 3 has them"},
    {"bsdf/principled_parameters.h", "GREATER(wo.z + wi.z, (Float)1e-30f)", "divisor of a quotient that is not selected"},
    {"bsdf/ward.h", "GREATER(h.z, (Float)1e-9f)", "divisor of a quotient that is not selected"},
    {"caustics/guide.h", "(Float)0x1p-18f), (Float)(1.0f - 0x1p-18f)", "margin of a bin of directions, of which no rounding leads out"},
    {"lights/rectangle.h", "ONE), (Float)0x1p-40f)", "square of a sine below the rounding of its cosine"},
    {"lights/rectangle.h", "GREATER(square, (Float)0x1p-80f)", "divisor of a quotient that is clamped to the rectangle"},
    {"lights/light_tree.h", "#define HORIZON_SLACK 0x1p-13f", "rounding of coded normals: lights are sampled rather too often"},
    {"lights/light_tree.h", "#define LEAST_DISTANCE2 0x1p-100f", "keeps importances finite"},
    {"lights/light_tree.h", "#define LEAST_SHALLOW 0x1p-12f", "where the digits of a random number run out"},
    {"lights/envmap.h", "#define LEAST_POLE_SINE 0x1p-36f", "keeps a density finite"},
    {"shapes/few_pencil.h", "#define PENCIL_VOLUME 0x1p-10f", "where rounding could tell otherwise: such triangles are tested"},
    {"shapes/box_test.h", "least = 0x1p-60f", "component of a unit direction that divides"},
    {"shapes/box_test.h", "least = (Float)0x1p-60f", "the same of lanes"},
};

// Coefficients of polynomials.
const std::vector<std::string> tables{"core/math.h", "core/erf.h"};

bool is_known(const std::string& file, const std::string& line) {
    return std::ranges::any_of(known_constants, [&](const Known& k) { return file == k.file && line.find(k.text) != std::string::npos; });
}

std::vector<std::string> small_constants(const std::string& file, std::istream& text) {
    static const std::regex small(R"((^|[^\w.])(\d+\.?\d*e-\d+|0x[\da-f.]+p-\d+|0?\.000\d*)f?\b)");
    std::vector<std::string> found;
    std::string line;
    for (int number = 1; std::getline(text, line); ++number) {
        const std::string code = line.substr(0, line.find("//"));
        std::smatch match;
        if (!std::regex_search(code, match, small) || is_known(file, line)) continue;
        // Binary fractions down to 1/256 are proportions.
        if (std::stod(match[2].str()) < 1.0 / 256.0) found.push_back(file + ":" + std::to_string(number) + ": " + line);
    }
    return found;
}

TEST(FixedEpsilons, AreNotInTheKernels) {
    const fs::path folder = fs::path(WAVELOBE_SOURCE_DIR) / "kernels";
    std::size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string file = fs::relative(entry.path(), folder).generic_string();
        if (!entry.is_regular_file() || std::ranges::count(tables, file) > 0) continue;
        ++files;
        std::ifstream text(entry.path());
        for (const std::string& found : small_constants(file, text)) ADD_FAILURE() << found << "\na fixed epsilon, or a constant to be listed here with its reason";
    }
    EXPECT_GT(files, 50U);
}

TEST(FixedEpsilons, AreFound) {
    std::istringstream text("Float t = 1e-4f;\nFloat u = x + 0.0001f;\nFloat v = 0x1p-20f; // a reason\nFloat w = 0.5f; // 1e-6\n");
    EXPECT_EQ(small_constants("shapes/new.h", text).size(), 3U);
}

}  // namespace
}  // namespace wavelobe
