// Spectra of scene files, and the linear sRGB colours that take their place: this renderer carries no wavelengths.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"

namespace wavelobe {

// Piecewise linear between samples, zero outside. At least two samples, wavelengths in nm and increasing.
struct SampledSpectrum {
    std::vector<double> wavelengths;
    std::vector<double> values;
};

// The light a spectrum's colour is seen under: D65 for what reflects or filters, so that a constant of 1 is white; none for
// what emits.
enum class Illuminant { none, d65 };

// By the CIE 1931 matching functions, normalized to a luminance of 1 for the constant 1. Components may be negative, and
// above 1: callers clamp to what their parameter allows.
glm::dvec3 spectrum_to_rgb(const SampledSpectrum& spectrum, Illuminant illuminant);

// The colour of the constant spectrum 1 without an illuminant: not white in sRGB, whose white point is D65.
glm::dvec3 equal_energy_rgb();

// Planck's law, W / (m^2 sr nm), over the visible wavelengths; temperature in kelvin.
SampledSpectrum blackbody(double kelvin);

// Lines of a wavelength and a value; `#` starts a comment. Throws InputError with the line.
SampledSpectrum load_spd(const std::string& path);

// What is wrong with a spectrum's samples; empty when nothing is.
std::string fault_of(const SampledSpectrum& spectrum);

}  // namespace wavelobe
