#include "scene/spectrum.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "scene/cie_tables.h"
#include "scene/fault.h"
#include "scene/file.h"

namespace wavelobe {

namespace {

// Mitsuba's convention: a Riemann sum over this many wavelengths, normalized by these integrals of the luminous efficiency
// and of D65's luminance.
constexpr int steps = 1000;
constexpr double luminance_integral = 106.7502593994140625;
constexpr double d65_normalization = 98.99741751876255;

CieRow cie_at(double nm) {
    const double position = (nm - cie_first_nm) / (cie_last_nm - cie_first_nm) * (cie_table.size() - 1);
    const auto index = std::min(static_cast<std::size_t>(std::max(position, 0.0)), cie_table.size() - 2);
    const double t = position - static_cast<double>(index);
    const CieRow& a = cie_table[index];
    const CieRow& b = cie_table[index + 1];
    return {std::lerp(a.x, b.x, t), std::lerp(a.y, b.y, t), std::lerp(a.z, b.z, t), std::lerp(a.d65, b.d65, t)};
}

glm::dvec3 xyz_to_srgb(const glm::dvec3& xyz) {
    return {3.240479 * xyz.x - 1.537150 * xyz.y - 0.498535 * xyz.z,
            -0.969256 * xyz.x + 1.875991 * xyz.y + 0.041556 * xyz.z,
            0.055648 * xyz.x - 0.204043 * xyz.y + 1.057311 * xyz.z};
}

double value_at(const SampledSpectrum& spectrum, double nm) {
    const std::vector<double>& w = spectrum.wavelengths;
    if (nm < w.front() || nm > w.back()) return 0.0;
    const auto above = static_cast<std::size_t>(std::upper_bound(w.begin(), w.end(), nm) - w.begin());
    const std::size_t i = std::min(std::max<std::size_t>(above, 1), w.size() - 1) - 1;
    return std::lerp(spectrum.values[i], spectrum.values[i + 1], (nm - w[i]) / (w[i + 1] - w[i]));
}

// Numbers of one line, which end at a comment; nothing when one cannot be read.
bool parse_line(std::string_view line, std::vector<double>& numbers) {
    line = line.substr(0, line.find('#'));
    constexpr std::string_view blanks = " \t\r,;:";
    std::size_t begin = line.find_first_not_of(blanks);
    while (begin != std::string_view::npos) {
        const std::size_t end = std::min(line.find_first_of(blanks, begin), line.size());
        double number = 0.0;
        if (line[begin] == '+' && begin + 1 < end) ++begin;
        const auto [stop, error] = std::from_chars(line.data() + begin, line.data() + end, number);
        if (error != std::errc{} || stop != line.data() + end || !std::isfinite(number)) return false;
        numbers.push_back(number);
        begin = line.find_first_not_of(blanks, end);
    }
    return true;
}

}  // namespace

glm::dvec3 spectrum_to_rgb(const SampledSpectrum& spectrum, Illuminant illuminant) {
    glm::dvec3 xyz(0.0);
    for (int i = 0; i < steps; ++i) {
        const double nm = std::lerp(cie_first_nm, cie_last_nm, static_cast<double>(i) / (steps - 1));
        const CieRow cie = cie_at(nm);
        const double light = illuminant == Illuminant::d65 ? cie.d65 / d65_normalization : 1.0;
        xyz += glm::dvec3(cie.x, cie.y, cie.z) * (value_at(spectrum, nm) * light);
    }
    return xyz_to_srgb(xyz * ((cie_last_nm - cie_first_nm) / (luminance_integral * steps)));
}

glm::dvec3 equal_energy_rgb() { return xyz_to_srgb(glm::dvec3(1.0)); }

SampledSpectrum blackbody(double kelvin) {
    constexpr double light_speed = 2.99792458e8, planck = 6.62607015e-34, boltzmann = 1.380649e-23;
    SampledSpectrum spectrum;
    for (double nm = cie_first_nm; nm <= cie_last_nm; nm += 1.0) {
        const double metres = nm * 1e-9;
        const double exponent = planck * light_speed / (metres * boltzmann * kelvin);
        spectrum.wavelengths.push_back(nm);
        spectrum.values.push_back(1e-9 * 2.0 * planck * light_speed * light_speed /
                                  (std::pow(metres, 5.0) * std::expm1(exponent)));
    }
    return spectrum;
}

std::string fault_of(const SampledSpectrum& spectrum) {
    if (spectrum.wavelengths.size() < 2) return "a spectrum has at least two wavelengths";
    if (spectrum.wavelengths.size() != spectrum.values.size())
        return "a spectrum has as many values as wavelengths, found " + std::to_string(spectrum.values.size()) + " and " +
               std::to_string(spectrum.wavelengths.size());
    for (std::size_t i = 1; i < spectrum.wavelengths.size(); ++i)
        if (spectrum.wavelengths[i] <= spectrum.wavelengths[i - 1])
            return "the wavelengths of a spectrum increase; number " + std::to_string(i + 1) + " does not";
    return {};
}

SampledSpectrum load_spd(const std::string& path) {
    const std::string content = read_file(path);
    SampledSpectrum spectrum;
    int line = 0;
    for (std::size_t begin = 0; begin < content.size();) {
        const std::size_t end = std::min(content.find('\n', begin), content.size());
        ++line;
        std::vector<double> numbers;
        if (!parse_line(std::string_view(content).substr(begin, end - begin), numbers) ||
            (!numbers.empty() && numbers.size() != 2))
            throw InputError(Fault{path, line, 1, "", "expected a wavelength in nm and a value", "correct the line"});
        if (!numbers.empty()) {
            spectrum.wavelengths.push_back(numbers[0]);
            spectrum.values.push_back(numbers[1]);
        }
        begin = end + 1;
    }
    if (const std::string fault = fault_of(spectrum); !fault.empty())
        throw InputError(Fault{path, 0, 0, "", fault, "correct the file"});
    return spectrum;
}

}  // namespace wavelobe
