#include "libvdbsynth/math/trigonometry.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace vdbsynth {
namespace {

// Taylor series on [-pi/4, pi/4]; the first omitted term is below 1e-17 there.
double sineSeries(double x) noexcept {
    const double s = x * x;
    return x * (1 + s * (-1.0 / 6 +
                         s * (1.0 / 120 +
                              s * (-1.0 / 5040 +
                                   s * (1.0 / 362880 + s * (-1.0 / 39916800 + s * (1.0 / 6227020800.0 -
                                                                                   s / 1307674368000.0)))))));
}

double cosineSeries(double x) noexcept {
    const double s = x * x;
    return 1 + s * (-0.5 + s * (1.0 / 24 + s * (-1.0 / 720 +
                                                s * (1.0 / 40320 + s * (-1.0 / 3628800 +
                                                                        s * (1.0 / 479001600.0 +
                                                                             s * (-1.0 / 87178291200.0 +
                                                                                  s / 20922789888000.0)))))));
}

double quarterTurns(double angle, int turns) noexcept {
    const double quarter = std::floor(angle * (2 / kPi) + 0.5);
    // Cody-Waite: pi/2 in two parts keeps the remainder exact for moderate angles.
    const double rest = (angle - quarter * 1.5707963267341256) - quarter * 6.0771005065061922e-11;
    const int phase = (int(std::fmod(quarter, 4.0)) + turns + 8) & 3;
    switch (phase) {
        case 0:
            return sineSeries(rest);
        case 1:
            return cosineSeries(rest);
        case 2:
            return -sineSeries(rest);
        default:
            return -cosineSeries(rest);
    }
}

}  // namespace

double sine(double angle) noexcept {
    return quarterTurns(angle, 0);
}
double cosine(double angle) noexcept {
    return quarterTurns(angle, 1);
}

double arcTangent(double y, double x) noexcept {
    if (y == 0) return x < 0 ? kPi : 0;
    if (y < 0) return -arcTangent(-y, x);
    if (x < 0) return kPi - arcTangent(y, -x);
    if (y > x) return kPi / 2 - arcTangent(x, y);
    // The tangent's difference to the nearest quarter c is below 1 / 8: atan(t) = atan(c) + atan((t - c) / (1
    // + t c)).
    constexpr double kArcs[5] = {0, 0.24497866312686414, 0.46364760900080615, 0.64350110879328437,
                                 0.78539816339744828};
    const int quarter = (y > 0.125 * x) + (y > 0.375 * x) + (y > 0.625 * x) + (y > 0.875 * x);
    const double c = 0.25 * quarter, t = (y - c * x) / (x + c * y), s = t * t;
    const double series =
        s *
        (-1.0 / 3 +
         s * (1.0 / 5 +
              s * (-1.0 / 7 + s * (1.0 / 9 + s * (-1.0 / 11 + s * (1.0 / 13 + s * (-1.0 / 15 + s / 17)))))));
    return kArcs[quarter] + (t + t * series);
}

double exponential(double power) noexcept {
    if (std::isnan(power)) return power;
    if (power > 709.79) return std::numeric_limits<double>::infinity();
    if (power < -745.2) return 0;
    // power = n ln 2 + rest; ln 2 in two parts, the first with enough trailing
    // zeros that n times it is exact.
    const double n = std::floor(power * 1.4426950408889634 + 0.5);
    const double r = (power - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;
    const double sum =
        0.5 + r * (1.0 / 6 +
                   r * (1.0 / 24 +
                        r * (1.0 / 120 +
                             r * (1.0 / 720 +
                                  r * (1.0 / 5040 +
                                       r * (1.0 / 40320 +
                                            r * (1.0 / 362880 +
                                                 r * (1.0 / 3628800 +
                                                      r * (1.0 / 39916800 +
                                                           r * (1.0 / 479001600 + r / 6227020800.0))))))))));
    const double value = 1 + (r + r * r * sum);
    if (n < -1000 || n > 1000) return std::ldexp(value, int(n));
    const std::uint64_t bits = std::uint64_t(int(n) + 1023) << 52;  // 2^n
    double scale;
    std::memcpy(&scale, &bits, sizeof scale);
    return value * scale;
}

double logarithm2(double number) noexcept {
    int exponent = 0;
    double m = std::frexp(number, &exponent);
    if (m < 0.70710678118654752) {
        m *= 2;
        --exponent;
    }
    // ln m = 2 artanh((m - 1) / (m + 1)), whose argument is below 0.172.
    const double t = (m - 1) / (m + 1), s = t * t;
    double sum = 0;
    for (int n = 25; n >= 1; n -= 2) sum = 1.0 / n + s * sum;
    return exponent + 2 * 1.4426950408889634 * t * sum;
}

}  // namespace vdbsynth
