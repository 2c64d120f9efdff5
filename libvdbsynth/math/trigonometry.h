#pragma once

namespace vdbsynth {

inline constexpr double kPi = 3.14159265358979323846;

/// Replacements for functions of the C library that give the same bits on every x86-64 processor: the library
/// switches to other code, with another last bit, on processors with fused multiply-add. Functions that round
/// exactly (sqrt, floor, fmod, ldexp) need no replacement.

/// @param angle  [radians], |angle| under 1e4; absolute error below 1e-12 there,
/// below 1e-15 for |angle| under 7
double sine(double angle) noexcept;
double cosine(double angle) noexcept;

/// The angle of (x, y) to the x axis [radians], -pi..pi, for sizes under 1e307; 0 for (0, 0), pi for y = 0 >
/// x whatever the sign of that zero. Absolute error below 1e-15.
double arcTangent(double y, double x) noexcept;

/// e to the power, infinite over 709.78, 0 below -745.13. Relative error below 1e-15 if
/// the result is over 1e-307.
double exponential(double power) noexcept;

/// Logarithm to base 2, exact for powers of two. @param number  over 0, finite. Absolute error below 1e-15 +
/// 1e-15 times the result.
double logarithm2(double number) noexcept;

}  // namespace vdbsynth
