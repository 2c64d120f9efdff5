#pragma once
#include <complex>
#include <cstddef>
#include <memory>
#include <vector>

namespace vdbsynth {

/// Four numbers in parallel, from four lines that are transformed at the same time. Compilers keep them in
/// one vector register, which makes the transform fast: its steps are the same for every line.
struct Lanes {
    static constexpr int kCount = 4;
    typedef float Vector __attribute__((vector_size(4 * kCount)));

    Vector values;

    Lanes() = default;
    Lanes(double all) : values(Vector{} + float(all)) {}
    explicit Lanes(Vector of) : values(of) {}
    /// The first of them; the transform's own constants are equal in all.
    operator double() const { return double(values[0]); }

    Lanes& operator+=(const Lanes& b) { return values += b.values, *this; }
    Lanes& operator-=(const Lanes& b) { return values -= b.values, *this; }
    Lanes& operator*=(const Lanes& b) { return values *= b.values, *this; }
};
inline Lanes operator-(const Lanes& a) {
    return Lanes(-a.values);
}
inline Lanes operator+(const Lanes& a, const Lanes& b) {
    return Lanes(a.values + b.values);
}
inline Lanes operator-(const Lanes& a, const Lanes& b) {
    return Lanes(a.values - b.values);
}
inline Lanes operator*(const Lanes& a, const Lanes& b) {
    return Lanes(a.values * b.values);
}

using ComplexLanes = std::complex<Lanes>;

/// Discrete Fourier transforms of four complex lines at once, by kissfft, whose template takes any number
/// type, here four numbers.
///     out[k] = sum over i of in[i] e^(-2 pi sqrt(-1) i k / length), not divided by the length
class LineTransform {
public:
    /// @param length  at least 1; fast if transformLength returns it unchanged
    explicit LineTransform(int length);
    LineTransform(LineTransform&&) noexcept;
    LineTransform& operator=(LineTransform&&) noexcept;
    ~LineTransform();

    int length() const;
    /// @param in, out  [length], not the same
    /// @par Cost O(length log(length)) for lengths of small factors  @par Repeats yes; safe from many
    /// threads for lengths that transformLength gives
    void run(const ComplexLanes* in, ComplexLanes* out) const;

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

/// The smallest length of at least `atLeast` without a prime factor over 5.
int transformLength(int atLeast);

/// Bound of the rounding error of a transform of `samples` numbers (of all axes together), as a share of its
/// result's 2-norm [higham2002, Theorem 24.2]: the bound for each factor of two, times their number. Errors
/// of roots of unity, at most 7e-7, are most of it.
double transformRounding(double samples);

}  // namespace vdbsynth
