#include "libvdbsynth/math/line_transform.h"

#include "libvdbsynth/math/trigonometry.h"

#include <cmath>

namespace vdbsynth {

// The operations that kissfft needs besides adding and multiplying: to compute roots of unity, once.
static Lanes cos(const Lanes& angle) {
    return {cosine(double(angle))};
}
static Lanes sin(const Lanes& angle) {
    return {sine(double(angle))};
}
static Lanes exp(const Lanes& power) {
    return {exponential(double(power))};
}
static Lanes operator*(std::size_t times, const Lanes& angle) {
    return {double(times) * double(angle)};
}

}  // namespace vdbsynth

#include <kissfft/kissfft.hh>

namespace vdbsynth {

struct LineTransform::Impl {
    explicit Impl(int n) : length(n), transform(std::size_t(n), false) {}
    int length;
    kissfft<Lanes> transform;
};

LineTransform::LineTransform(int length) : mImpl(std::make_unique<Impl>(length)) {}
LineTransform::LineTransform(LineTransform&&) noexcept = default;
LineTransform& LineTransform::operator=(LineTransform&&) noexcept = default;
LineTransform::~LineTransform() = default;

int LineTransform::length() const {
    return mImpl->length;
}

void LineTransform::run(const ComplexLanes* in, ComplexLanes* out) const {
    mImpl->transform.transform(in, out);
}

int transformLength(int atLeast) {
    for (int length = atLeast;; ++length) {
        int rest = length;
        for (int factor : {2, 3, 5})
            while (rest % factor == 0) rest /= factor;
        if (rest == 1) return length;
    }
}

double transformRounding(double samples) {
    return 1.3e-6 * std::ceil(logarithm2(samples));
}

}  // namespace vdbsynth
