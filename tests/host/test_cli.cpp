// The program as its users meet it: options, messages, exit codes, files.
#include <gtest/gtest.h>

#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include "cli/exit_code.h"
#include "cli/format.h"
#include "cli/health.h"
#include "cli/progress.h"
#include "cli/render_report.h"
#include "scene/image.h"
#include "support/process.h"

namespace wavelobe {
namespace {

namespace fs = std::filesystem;

constexpr const char* scene_text = R"(<scene version="3.0.0">
    <default name="spp" value="4"/>
    <integrator type="path"><integer name="max_depth" value="3"/></integrator>
    <sensor type="perspective">
        <transform name="to_world"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
        <sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
        <film type="hdrfilm">
            <integer name="width" value="64"/> <integer name="height" value="48"/> <rfilter type="box"/>
        </film>
    </sensor>
    <shape type="rectangle"><bsdf type="diffuse"/></shape>
    <emitter type="constant"/>
</scene>
)";

class Program : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("wavelobe_cli_" + std::to_string(getpid()));
        fs::create_directories(folder_);
        std::ofstream(folder_ / "scene.xml") << scene_text;
    }
    void TearDown() override { fs::remove_all(folder_); }

    struct Result {
        int code;
        std::string output;
        std::string errors;
    };
    Result run(const std::vector<std::string>& arguments) const {
        test::Process process(arguments, folder_);
        const int code = process.wait();
        return {code, process.output(), process.errors()};
    }
    void expect_refused(const std::vector<std::string>& arguments, const std::string& message) const {
        const Result result = run(arguments);
        EXPECT_EQ(result.code, exit_bad_input) << message;
        EXPECT_EQ(result.errors.rfind("error: ", 0), 0U) << result.errors;
        EXPECT_NE(result.errors.find(message), std::string::npos) << result.errors;
        EXPECT_EQ(result.output, "");
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    fs::path folder_;
};

std::string last_line(const std::string& text) {
    const std::size_t end = text.find_last_not_of('\n') + 1;
    const std::size_t start = text.rfind('\n', end - 1);
    return text.substr(start == std::string::npos ? 0 : start + 1, end - (start == std::string::npos ? 0 : start + 1));
}

TEST_F(Program, HelpAndVersionEverywhere) {
    for (const std::string command : {"", "render", "info", "doctor", "compare"}) {
        for (const std::string option : {"--help", "--version"}) {
            const Result result = run(command.empty() ? std::vector{option} : std::vector{command, option});
            EXPECT_EQ(result.code, exit_ok) << command;
            EXPECT_EQ(result.errors, "") << command;
            const char* expected = option == "--version" ? "wavelobe " WAVELOBE_VERSION "\n" : "Usage: wavelobe";
            EXPECT_NE(result.output.find(expected), std::string::npos) << result.output;
        }
    }
}

TEST_F(Program, RefusesWrongCommandLines) {
    expect_refused({}, "a command is required, one of render info doctor compare");
    expect_refused({"paint"}, "a command is required");
    expect_refused({"render"}, "SCENE is required");
    expect_refused({"render", "scene.xml"}, "--output is required");
    expect_refused({"render", "scene.xml", "-o", "a.exr", "--wrong"}, "--wrong");
    expect_refused({"render", "scene.xml", "-o", "a.exr", "--spp", "0"}, "--spp: \"0\" is not a whole number from 1");
    expect_refused({"render", "scene.xml", "-o", "a.exr", "--spp", "1e3"}, "--spp: \"1e3\" is not a whole number");
    expect_refused({"render", "scene.xml", "-o", "a.exr", "--seed", "-1"}, "--seed: \"-1\" is not a whole number from 0");
    expect_refused({"render", "scene.xml", "-o", "a.exr", "--threads", "0"}, "--threads");
    expect_refused({"render", "scene.xml", "-o", "a.exr", "--max-depth", "-2"}, "--max-depth");
    expect_refused({"render", "scene.xml", "-o", "a.exr", "-D", "spp"}, "\"spp\" is not of the form NAME=VALUE");
    expect_refused({"render", "scene.xml", "-o", "a.exr", "--crop", "0,0,8"}, "\"0,0,8\" is not of the form X0,Y0,X1,Y1");
    expect_refused({"render", "scene.xml", "-o", "a.exr", "--crop", "0,0,65,48"}, "film of 64 x 48 pixels");
    expect_refused({"render", "scene.xml", "-o", "a.exr", "--crop", "8,8,8,9"}, "at least one pixel");
    expect_refused({"render", "scene.xml", "--replay", "1,2"}, "\"1,2\" is not of the form X,Y,S");
    expect_refused({"render", "scene.xml", "--replay", "64,2,0"}, "columns are 0 to 63, rows 0 to 47");
    expect_refused({"render", "scene.xml", "--replay", "63,2,4", "--spp", "4"}, "samples are 0 to 3; --spp says how many a pixel has");
    EXPECT_FALSE(fs::exists(path("a.exr")));
}

TEST_F(Program, ReplaysAPath) {
    const Result result = run({"render", "scene.xml", "--replay", "32,24,2", "--quiet"});
    EXPECT_EQ(result.code, exit_ok) << result.errors;
    EXPECT_EQ(result.output.rfind("vertex 0: scatter_diffuse, hit shape 0 primitive ", 0), 0U) << result.output;
    EXPECT_NE(result.output.find("\n  light sample: intersect_shadow, from shape 0 "), std::string::npos) << result.output;
    EXPECT_EQ(last_line(result.output).rfind("radiance of the sample: (0.", 0), 0U) << result.output;
}

TEST_F(Program, NamesAMissingSceneOrPicture) {
    expect_refused({"render", "none.xml", "-o", "a.exr"}, "none.xml");
    expect_refused({"info", "none.xml"}, "none.xml");
    expect_refused({"compare", "none.exr", "none.exr"}, "none.exr");
}

TEST_F(Program, RefusesOutputsThatCannotBeWrittenBeforeReadingTheScene) {
    expect_refused({"render", "none.xml", "-o", "none/a.exr"}, "error: none/a.exr: cannot be written: there is no folder");
    expect_refused({"render", "none.xml", "-o", "."}, "error: .: is a folder");
    expect_refused({"render", "none.xml", "-o", "a.exr", "--stats", "none/a.json"}, "error: none/a.json: cannot be written");
    expect_refused({"render", "none.xml", "-o", "a.exr", "--png", "/proc/a.png"}, "error: /proc/a.png: cannot be written");
    expect_refused({"render", "none.xml", "-o", "a.exr", "--png", "./a.exr"}, "named for two outputs");
    expect_refused({"compare", "none.exr", "none.exr", "--diff", "none/a.png"}, "error: none/a.png: cannot be written");
    EXPECT_FALSE(fs::exists(path("a.exr")));
}

TEST_F(Program, RendersAndReports) {
    const Result result = run({"render", "-D", "spp=2", "scene.xml", "-o", "a.exr", "--png", "a.png", "--stats", "a.json",
                               "--seed", "5", "--threads", "1", "--crop", "10,20,42,36", "--verbose"});
    ASSERT_EQ(result.code, exit_ok) << result.errors;
    const std::string closing = last_line(result.output);
    double numbers[4];
    int read = 0;
    std::sscanf(closing.c_str(), "render %lf s, setup %lf s, %lf M samples, %lf M samples/s%n", &numbers[0], &numbers[1],
                &numbers[2], &numbers[3], &read);
    EXPECT_EQ(read, static_cast<int>(closing.size())) << closing;
    EXPECT_NEAR(numbers[2], 32 * 16 * 2 / 1e6, 0.5e-5);  // three digits of it are printed
    EXPECT_NE(result.output.find("stage "), std::string::npos);
    EXPECT_TRUE(fs::exists(path("a.png")));

    const Imf::InputFile picture(path("a.exr").c_str());
    EXPECT_EQ(picture.header().dataWindow(), Imath::Box2i({10, 20}, {41, 35}));
    EXPECT_EQ(picture.header().displayWindow(), Imath::Box2i({0, 0}, {63, 47}));
    EXPECT_EQ(picture.header().typedAttribute<Imf::StringAttribute>("wavelobe.seed").value(), "5");

    const auto stats = nlohmann::json::parse(std::ifstream(path("a.json")));
    EXPECT_EQ(stats.at("samples"), 32 * 16 * 2);
    EXPECT_EQ(stats.at("spp"), 2);
    EXPECT_EQ(stats.at("seed"), 5);
    EXPECT_EQ(stats.at("width"), 32);
    EXPECT_EQ(stats.at("threads"), 1);
    EXPECT_EQ(stats.at("nan_samples"), 0);
    EXPECT_EQ(stats.at("complete"), true);
    EXPECT_GT(stats.at("render_seconds"), 0.0);
    double parts = 0.0;
    for (const auto& [part, seconds] : stats.at("setup").items()) parts += seconds.get<double>();
    EXPECT_NEAR(stats.at("setup_seconds").get<double>(), parts, 1e-9);
    EXPECT_TRUE(stats.at("setup").contains("parse"));
    EXPECT_FALSE(stats.at("stages").empty());
}

TEST_F(Program, QuietPrintsNothing) {
    const Result result = run({"render", "scene.xml", "-o", "a.exr", "--quiet"});
    EXPECT_EQ(result.code, exit_ok);
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(result.errors, "");
    EXPECT_TRUE(fs::exists(path("a.exr")));
}

TEST_F(Program, NamesTheDevicesWhenNoneFits) {
    const Result result = run({"render", "scene.xml", "-o", "a.exr", "--device", "no such device"});
    EXPECT_EQ(result.code, exit_failure);
    EXPECT_NE(result.errors.find("error: no OpenCL CPU device named \"no such device\""), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("wavelobe doctor"), std::string::npos);
}

TEST_F(Program, StopsAfterTheWaveAndKeepsTheSamplesMade) {
    for (const int signal : {SIGINT, SIGTERM}) {
        fs::remove(path("a.exr"));
        test::Process process({"render", "scene.xml", "-o", "a.exr", "--spp", "16777216", "--stats", "a.json"}, folder_);
        ASSERT_TRUE(process.wait_for_error_text("rendering 64 x 48", 120.0)) << process.errors();
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        process.send(signal);
        EXPECT_EQ(process.wait(), exit_interrupted);
        const Bitmap picture = load_image(path("a.exr"), Transfer::of_format);
        EXPECT_EQ(picture.width, 64);
        EXPECT_EQ(picture.height, 48);
        EXPECT_TRUE(std::any_of(picture.rgb.begin(), picture.rgb.end(), [](float value) { return value > 0.0F; }));
        const auto stats = nlohmann::json::parse(std::ifstream(path("a.json")));
        EXPECT_EQ(stats.at("complete"), false);
        EXPECT_GT(stats.at("samples"), 0);
        EXPECT_LT(stats.at("samples"), 64LL * 48 * 16777216);
    }
}

TEST_F(Program, InfoTellsWhatTheSceneHolds) {
    const Result result = run({"info", "scene.xml"});
    EXPECT_EQ(result.code, exit_ok) << result.errors;
    EXPECT_NE(result.output.find("64 x 48 pixels"), std::string::npos) << result.output;
    for (const char* row : {"camera", "integrator", "shapes", "materials", "emitters", "features", "memory"}) {
        EXPECT_NE(result.output.find(std::string("\n") + row + " "), std::string::npos) << row;
    }
}

TEST_F(Program, ComparesAPictureWithItself) {
    ASSERT_EQ(run({"render", "scene.xml", "-o", "a.exr", "-q"}).code, exit_ok);
    const Result result = run({"compare", "a.exr", "a.exr", "--diff", "d.png"});
    EXPECT_EQ(result.code, exit_ok) << result.errors;
    EXPECT_EQ(result.output.rfind("relMSE          0\n", 0), 0U) << result.output;
    EXPECT_TRUE(fs::exists(path("d.png")));
    ASSERT_EQ(run({"render", "scene.xml", "-o", "b.exr", "-q", "--crop", "0,0,8,8"}).code, exit_ok);
    expect_refused({"compare", "a.exr", "b.exr"}, "differ in size: 64 x 48 and 8 x 8");
}

TEST_F(Program, DoctorFindsWhatIsWrongAndTheRemedy) {
    setenv("POCL_WORK_GROUP_METHOD", "loops", 1);
    const Result result = run({"doctor"});
    unsetenv("POCL_WORK_GROUP_METHOD");
    EXPECT_EQ(result.code, exit_failure);
    EXPECT_NE(result.output.find("off (POCL_WORK_GROUP_METHOD=loops)"), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("remedy: unset POCL_WORK_GROUP_METHOD"), std::string::npos) << result.output;
}

// ---- doctor's findings one by one -------------------------------------------------------------------

std::string nothing_set(const char*) { return ""; }
std::string two_threads_set(const char* name) { return name == std::string("POCL_MAX_PTHREAD_COUNT") ? "2" : ""; }
std::string memory_limit_set(const char* name) { return name == std::string("POCL_MEMORY_LIMIT") ? "4" : ""; }
std::string cpu_set(const char* name) { return name == std::string("POCL_LLVM_CPU_NAME") ? "haswell" : ""; }
std::string cache_off(const char* name) { return name == std::string("POCL_KERNEL_CACHE") ? "0" : ""; }

DeviceInfo device_of(unsigned compute_units, unsigned float_width) {
    DeviceInfo info;
    info.compute_units = compute_units;
    info.native_float_width = float_width;
    info.memory_bytes = std::uint64_t{4} << 30;
    info.max_allocation_bytes = std::uint64_t{2} << 30;
    return info;
}

const Machine eight_cores{.threads = 8, .memory_bytes = std::uint64_t{16} << 30};

TEST(Health, FewerThreadsThanCoresAreBad) {
    EXPECT_EQ(examine_threads(device_of(8, 16), eight_cores, nothing_set).remedy, "");
    EXPECT_EQ(examine_threads(device_of(2, 16), eight_cores, two_threads_set).remedy, "unset POCL_MAX_PTHREAD_COUNT");
    EXPECT_NE(examine_threads(device_of(1, 16), eight_cores, nothing_set).remedy.find("taskset"), std::string::npos);
}

TEST(Health, SimdForAnotherProcessorIsBad) {
    const Finding good = examine_simd(device_of(8, 16), nothing_set);
    EXPECT_EQ(good.state, "16 floats (512 bits)");
    EXPECT_EQ(good.remedy, "");
    EXPECT_EQ(examine_simd(device_of(8, 16), cpu_set).remedy, "unset POCL_LLVM_CPU_NAME");
    EXPECT_NE(examine_simd(device_of(8, 1), nothing_set).remedy, "");
}

TEST(Health, AMemoryLimitIsBad) {
    const Finding good = examine_memory(device_of(8, 16), eight_cores, nothing_set);
    EXPECT_EQ(good.state, "4.0 GiB reported by the device, 2.0 GiB in one buffer; the machine has 16.0 GiB");
    EXPECT_EQ(good.remedy, "");
    const Finding limited = examine_memory(device_of(8, 16), eight_cores, memory_limit_set);
    EXPECT_NE(limited.remedy.find("POCL_MEMORY_LIMIT"), std::string::npos);
}

TEST(Health, ACacheThatCannotBeUsedIsBad) {
    const fs::path folder = fs::temp_directory_path() / ("wavelobe_health_" + std::to_string(getpid()));
    const Finding good = examine_cache(folder.string(), nothing_set);
    EXPECT_EQ(good.remedy, "");
    EXPECT_NE(good.state.find(", 0 B"), std::string::npos) << good.state;
    EXPECT_EQ(examine_cache(folder.string(), cache_off).remedy, "unset POCL_KERNEL_CACHE");
    EXPECT_NE(examine_cache("/proc/none", nothing_set).remedy.find("POCL_CACHE_DIR"), std::string::npos);
    fs::remove_all(folder);
}

// ---- text -------------------------------------------------------------------------------------------

TEST(Format, Numbers) {
    EXPECT_EQ(format_millions(41.23e6), "41.2 M");
    EXPECT_EQ(format_millions(1234e6), "1234 M");
    EXPECT_EQ(format_millions(65536), "0.0655 M");
    EXPECT_EQ(format_millions(0), "0.00 M");
    EXPECT_EQ(format_bytes(512), "512 B");
    EXPECT_EQ(format_bytes(std::uint64_t{3} << 29), "1.5 GiB");
    EXPECT_EQ(format_count(999), "999");
    EXPECT_EQ(format_count(1234567), "1,234,567");
    EXPECT_EQ(format_clock(61.2), "1:02");
    EXPECT_EQ(format_clock(7205.0), "2:00:05");
}

TEST(Format, Progress) {
    EXPECT_EQ(progress_text({420, 0.42, 0.0}), " 42 %");
    EXPECT_EQ(progress_text({10000000, 0.25, 5.0}), " 25 %  2.00 M samples/s  0:15 left");
    EXPECT_EQ(building_text(0.424), " 42 %  building the hierarchy");
}

TEST(Format, ClosingLineAndWarning) {
    RenderReport report;
    report.stats.render_seconds = 3.142;
    report.stats.setup_parts = {{"bvh", 0.2}, {"parse", 0.01}};
    report.stats.samples = 41200000;
    EXPECT_EQ(closing_line(report), "render 3.142 s, setup 0.210 s, 41.2 M samples, 13.1 M samples/s");
    EXPECT_EQ(non_finite_warning(report.stats), "");
    report.width = 10000;
    report.height = 4000;
    EXPECT_EQ(holes_warning(report), "");
    report.height = 5000;
    EXPECT_EQ(holes_warning(report), "8800000 of 50000000 pixels have no sample yet and are black: the picture was ended too soon");
    report.stats.nan_samples = 3;
    report.stats.nan_examples = {{{4, 5, 6}, "sort_paths"}, {{7, 8, 9}, "scatter_delta"}};
    EXPECT_EQ(non_finite_warning(report.stats),
              "3 samples were NaN or infinite and are left out of the picture; the first: pixel (4, 5) sample 6 in sort_paths, "
              "pixel (7, 8) sample 9 in scatter_delta\n  `--replay 4,5,6` in place of the output shows the first of these paths");
}

}  // namespace
}  // namespace wavelobe
