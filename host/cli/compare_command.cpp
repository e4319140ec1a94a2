#include <cstdio>
#include <memory>

#include <CLI/App.hpp>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "film/compare.h"
#include "film/png.h"
#include "film/replace_file.h"
#include "scene/image.h"

namespace wavelobe {
namespace {

struct CompareOptions {
    std::string picture;
    std::string reference;
    std::string difference;  // empty: none
};

Image read_picture(const std::string& path) {
    Bitmap bitmap = load_image(path, Transfer::of_format);
    return {bitmap.width, bitmap.height, std::move(bitmap.rgb)};
}

int run(const CompareOptions& options) {
    if (!options.difference.empty()) refuse_unwritable(options.difference);
    const Image picture = read_picture(options.picture);
    const Image reference = read_picture(options.reference);
    const Comparison result = compare_images(picture, reference);
    if (!options.difference.empty()) replace_file(options.difference, encode_png(difference_image(picture, reference)));

    if (result.non_finite_pixels > 0) {
        std::fprintf(stderr, "warning: %zu pixels are NaN or infinite in one of the pictures and are left out\n",
                     result.non_finite_pixels);
    }
    std::printf("relMSE          %.6g\n", result.rel_mse);
    std::printf("relMSE trimmed  %.6g   without the worst 0.1 %% of pixels\n", result.rel_mse_trimmed);
    std::printf("RMSE            %.6g\n", result.rmse);
    std::printf("MAE             %.6g\n", result.mae);
    std::printf("max difference  %.6g   at (%d, %d)\n", result.max_difference, result.max_x, result.max_y);
    const char* const names = "RGB";
    for (std::size_t i = 0; i < 3; ++i) {
        std::printf("mean %c          %.6g   reference %.6g", names[i], result.mean[i], result.reference_mean[i]);
        if (result.reference_mean[i] != 0.0) std::printf("   ratio %.5f", result.mean[i] / result.reference_mean[i]);
        std::printf("\n");
    }
    return exit_ok;
}

}  // namespace

void add_compare_command(CLI::App& program, Chosen& chosen) {
    CLI::App* command = program.add_subcommand("compare", "Measure how far a picture is from a reference");
    auto options = std::make_shared<CompareOptions>();
    command->add_option("PICTURE", options->picture, "EXR file")->required();
    command->add_option("REFERENCE", options->reference, "EXR file of the same size, taken as the truth")->required();
    command->add_option("--diff", options->difference, "Write the relative difference: red brighter, blue darker")
        ->type_name("OUT.png");
    command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace wavelobe
