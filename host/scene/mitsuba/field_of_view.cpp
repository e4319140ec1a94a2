// How wide a camera or projector sees.
#include "scene/mitsuba/field_of_view.h"

#include <cmath>

#include "scene/mitsuba/values.h"

namespace wavelobe::mitsuba {

namespace {

double degrees_of_tangent(double half_tangent) { return glm::degrees(2.0 * std::atan(half_tangent)); }

// The tangent of half the field of view that `fov` or `focal_length` states, and the axis it holds for.
struct FieldOfView {
    double half_tangent = 0.0;
    enum class Axis { x, y, diagonal, smaller, larger } axis = Axis::x;
};

FieldOfView read_field_of_view(Query& query) {
    if (query.has("fov") && query.has("focal_length"))
        query.fault("both `fov` and `focal_length` are given", "keep one of the two");
    using Axis = FieldOfView::Axis;
    const double fov = query.real("fov", 45.0, Range{0.0, 179.999, true});
    const auto axis = static_cast<Axis>(query.choice("fov_axis", {"x", "y", "diagonal", "smaller", "larger"}, 0));
    std::string focal_length = query.text("focal_length", "50mm");
    if (query.has("fov")) return {std::tan(glm::radians(fov) / 2.0), axis};

    // The diagonal of a 35 mm film frame, 36 x 24 mm.
    if (focal_length.ends_with("mm")) focal_length.resize(focal_length.size() - 2);
    const auto millimetres = parse_real(focal_length);
    if (!millimetres || *millimetres <= 0.0) {
        query.fault_at("focal_length", "cannot read the focal length; expected a positive number such as 50mm", "");
        return {std::tan(glm::radians(20.0)), Axis::x};
    }
    return {std::hypot(36.0, 24.0) / (2.0 * *millimetres), Axis::diagonal};
}

}  // namespace

float horizontal_degrees(Query& query, double aspect) {
    using Axis = FieldOfView::Axis;
    FieldOfView view = read_field_of_view(query);
    if (view.axis == Axis::smaller) view.axis = aspect > 1.0 ? Axis::y : Axis::x;
    if (view.axis == Axis::larger) view.axis = aspect > 1.0 ? Axis::x : Axis::y;
    if (view.axis == Axis::y) view.half_tangent *= aspect;
    if (view.axis == Axis::diagonal) view.half_tangent /= std::sqrt(1.0 + 1.0 / (aspect * aspect));
    return static_cast<float>(degrees_of_tangent(view.half_tangent));
}

}  // namespace wavelobe::mitsuba
