#include "tables/environment_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "scene/fault.h"
#include "tables/luminance.h"

namespace wavelobe {
namespace {

// Luminance of each texel.
std::vector<double> checked_luminance(const Bitmap& image, const std::string& name) {
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<double> result(image.rgb.size() / 3);
    for (std::size_t i = 0; i < result.size(); ++i) {
        const Rgb rgb(image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2]);
        for (int channel = 0; channel < 3; ++channel) {
            if (rgb[channel] >= 0.0F && std::isfinite(rgb[channel])) continue;
            throw InputError(Fault{.file = name,
                                   .element = "envmap",
                                   .message = "texel (" + std::to_string(i % width) + ", " + std::to_string(i / width) +
                                              ") is " + std::to_string(rgb[channel]) +
                                              ", where a finite radiance of at least 0 is expected",
                                   .hint = "mend the picture"});
        }
        result[i] = luminance(rgb);
    }
    return result;
}

// Solid angle of a cell of row `row` among `rows` by `columns`. The product of sines is the difference of the cosines of
// the two polar angles without its cancellation.
double cell_solid_angle(std::size_t row, std::size_t rows, std::size_t columns) {
    const double step = std::numbers::pi / static_cast<double>(rows);
    const double middle = (static_cast<double>(row) + 0.5) * step;
    return 2.0 * std::sin(middle) * std::sin(0.5 * step) * 2.0 * std::numbers::pi / static_cast<double>(columns);
}

// Takes the average radiance off each cell; an even picture keeps its weights.
void compensate(std::vector<double>& weight, double luminance_integral, std::size_t rows, std::size_t columns) {
    const double average = luminance_integral / (4.0 * std::numbers::pi);
    std::vector<double> rest(weight.size());
    for (std::size_t i = 0; i < weight.size(); ++i) {
        rest[i] = std::max(weight[i] - average * cell_solid_angle(i / columns, rows, columns), 0.0);
    }
    // Less than this share is rounding.
    if (std::accumulate(rest.begin(), rest.end(), 0.0) > 1e-6 * luminance_integral) weight = std::move(rest);
}

// From 0 to 1, in proportion to the weights; even where these are all zero.
void append_running_sum(std::vector<float>& sums, std::span<const double> weights) {
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    double sum = 0.0;
    sums.push_back(0.0F);
    for (std::size_t i = 0; i + 1 < weights.size(); ++i) {
        sum += total > 0.0 ? weights[i] / total : 1.0 / static_cast<double>(weights.size());
        sums.push_back(std::min(static_cast<float>(sum), 1.0F));
    }
    sums.push_back(1.0F);
}

// From the sums as they were rounded: what is drawn and what is said of it are the same.
void set_density(EnvironmentTable& table) {
    const std::size_t rows = table.cell_rows;
    const std::size_t columns = table.cell_columns;
    const auto step = [&](std::size_t i) { return static_cast<double>(table.sums[i + 1]) - static_cast<double>(table.sums[i]); };
    table.density.reserve(rows * columns);
    for (std::size_t y = 0; y < rows; ++y) {
        const double row = step(rows * (columns + 1) + y) * static_cast<double>(rows * columns);
        for (std::size_t x = 0; x < columns; ++x) table.density.push_back(static_cast<float>(row * step(y * (columns + 1) + x)));
    }
}

}  // namespace

Bitmap with_three_rows(Bitmap image) {
    const auto row = static_cast<std::size_t>(image.width) * 3;
    while (image.height > 0 && image.height < 3) {
        const std::vector<float> last(image.rgb.end() - static_cast<std::ptrdiff_t>(row), image.rgb.end());
        image.rgb.insert(image.rgb.end(), last.begin(), last.end());
        ++image.height;
    }
    return image;
}

EnvironmentTable build_environment_table(const Bitmap& image, const std::string& name, bool compensated) {
    if (image.width < 1 || image.height < 2) {
        throw InputError(Fault{.file = name,
                               .element = "envmap",
                               .message = "the picture has " + std::to_string(image.width) + " x " +
                                          std::to_string(image.height) + " texels, where at least 1 x 2 are expected",
                               .hint = {}});
    }
    const auto columns = static_cast<std::size_t>(image.width);
    const auto rows = static_cast<std::size_t>(image.height) - 1;
    const std::vector<double> texel = checked_luminance(image, name);

    std::vector<double> weight(columns * rows);
    for (std::size_t y = 0; y < rows; ++y) {
        const double solid_angle = cell_solid_angle(y, rows, columns);
        for (std::size_t x = 0; x < columns; ++x) {
            const std::size_t next = (x + 1) % columns;
            const double corners = texel[y * columns + x] + texel[y * columns + next] + texel[(y + 1) * columns + x] +
                                   texel[(y + 1) * columns + next];
            weight[y * columns + x] = 0.25 * corners * solid_angle;
        }
    }
    EnvironmentTable table;
    table.cell_columns = static_cast<Uint32>(columns);
    table.cell_rows = static_cast<Uint32>(rows);
    table.luminance_integral = std::accumulate(weight.begin(), weight.end(), 0.0);
    if (compensated) compensate(weight, table.luminance_integral, rows, columns);
    if (table.luminance_integral <= 0.0) {
        for (std::size_t i = 0; i < weight.size(); ++i) weight[i] = cell_solid_angle(i / columns, rows, columns);
    }

    std::vector<double> row_weight(rows);
    for (std::size_t y = 0; y < rows; ++y) {
        const std::span<const double> row = std::span(weight).subspan(y * columns, columns);
        row_weight[y] = std::accumulate(row.begin(), row.end(), 0.0);
        append_running_sum(table.sums, row);
    }
    append_running_sum(table.sums, row_weight);
    set_density(table);
    return table;
}

}  // namespace wavelobe
