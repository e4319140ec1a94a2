// Whole pictures of an edge between black and white: each pixel is the filter's integral over the white side, overshoot and all.
#include "support/render.h"

namespace wavelobe::test {
namespace {

constexpr int pixels = 16;
constexpr double edge = 7.6;  // pixels from the left

// A white screen that fills the picture to the right of the edge.
Scene edge_scene(const ReconstructionFilter& filter) {
    Scene scene = empty_scene(pixels);
    scene.film.filter = filter;
    look_at(scene, {0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 90.0F);
    // At z = 1 the picture is [-1, 1]^2, +x to the left.
    const auto x = static_cast<float>(1.0 - 2.0 * edge / pixels);
    make_emitter(add_quad(scene, {x, -9, 1}, {-9, 0, 0}, {0, 18, 0}, add_diffuse(scene, Rgb{0})), Rgb{1});
    return scene;
}

// Integral of the filter from x on over its whole integral, by the midpoint rule.
double share_beyond(const ReconstructionFilter& f, double x) {
    const auto value = [&](double t) {
        t = std::abs(t);
        if (f.kind == ReconstructionFilter::Kind::lanczos) {
            const double a = 3.14159265358979323846 * t;
            return t < 1e-9 ? 1.0 : std::sin(a) * std::sin(a / f.radius) * f.radius / (a * a);
        }
        const double b = f.b, c = f.c;
        if (t < 1) return 1 - b / 3 + t * t * ((2 * b + c - 3) + t * (2 - 1.5 * b - c));
        const double s = 2 - t;
        return (s * s * s * (b + 6 * c) - 6 * c * s * s) / 6;
    };
    constexpr int steps = 20000;
    double beyond = 0, all = 0;
    for (int i = 0; i < steps; ++i) {
        const double t = ((i + 0.5) / steps * 2 - 1) * f.radius;
        all += value(t);
        if (t >= x) beyond += value(t);
    }
    return beyond / all;
}

void expect_edge(const Image& image, const ReconstructionFilter& filter) {
    bool overshoots = false;
    for (int x = 0; x < pixels; ++x) {
        const double expected = share_beyond(filter, edge - (x + 0.5));
        overshoots = overshoots || expected < -0.01;
        double mean = 0, squares = 0;
        for (int y = 0; y < pixels; ++y) {
            const double value = pixel(image, static_cast<std::size_t>(y * pixels + x)).g;
            mean += value / pixels;
            squares += value * value / pixels;
        }
        const double error = std::sqrt(std::max(squares - mean * mean, 0.0) / (pixels - 1));
        EXPECT_NEAR(mean, expected, 5 * error + 1e-3) << "column " << x;
        EXPECT_LT(error, 0.01) << "too noisy a picture";
    }
    EXPECT_TRUE(overshoots) << "a test that says nothing of negative weights";
}

TEST(Filters, EdgesOvershootAsTheFilterDoes) {
    for (const ReconstructionFilter& filter :
         {ReconstructionFilter{.kind = ReconstructionFilter::Kind::mitchell}, {.kind = ReconstructionFilter::Kind::mitchell, .b = 0, .c = 0.5F},
          {.kind = ReconstructionFilter::Kind::lanczos, .radius = 3.0F}}) {
        expect_edge(render(edge_scene(filter), 512).image, filter);
    }
}

// The two halves of the film weigh their samples alike.
TEST(Filters, NegativeWeightsAndErrorEstimates) {
    const ReconstructionFilter filter{.kind = ReconstructionFilter::Kind::lanczos, .radius = 2.0F};
    RenderSettings settings;
    settings.samples_per_pixel = 512;
    settings.target_error = 1e-9;
    expect_edge(render(edge_scene(filter), settings).image, filter);
}

}  // namespace
}  // namespace wavelobe::test
