#include "libvdbsynth/math/trigonometry.h"

#include <cmath>

namespace vdbsynth {
namespace {

// Taylor series on [-pi/4, pi/4]; the first term left out is below 1e-17 there.
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
    if (x < 0) return kPi - arcTangent(y, -x);
    if (y > x) return kPi / 2 - arcTangent(x, y);
    // Two halvings bring the tangent under 0.2: tan(a / 2) = t / (1 + sqrt(1 + t^2)).
    double t = y / x;
    for (int i = 0; i < 2; ++i) t = t / (1 + std::sqrt(1 + t * t));
    const double squared = t * t;
    double sum = 0;
    for (int n = 21; n >= 1; n -= 2) sum = 1.0 / n - squared * sum;
    return 4 * t * sum;
}

}  // namespace vdbsynth
