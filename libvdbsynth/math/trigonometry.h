#pragma once

namespace vdbsynth {

inline constexpr double kPi = 3.14159265358979323846;

/// Sine and cosine that give the same bits on every x86-64 processor: the C library picks other code,
/// with another last bit, where the processor has fused multiply-add.
/// @param angle  [radians], |angle| under 1e4; absolute error below 1e-12 there, below 1e-14 for |angle|
/// under 7
double sine(double angle) noexcept;
double cosine(double angle) noexcept;

/// The angle of (x, y) to the x axis [radians], 0..pi, for y >= 0; 0 for (0, 0). Absolute error below 1e-13.
double arcTangent(double y, double x) noexcept;

}  // namespace vdbsynth
