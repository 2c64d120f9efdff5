#include "libvdbsynth/math/line_transform.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <complex>
#include <vector>

#include "libvdbsynth/base/random.h"

using namespace vdbsynth;

namespace {

using Complex = std::complex<double>;

std::vector<ComplexLanes> randomLines(int length, std::uint64_t seed) {
    std::vector<ComplexLanes> lines;
    for (int i = 0; i < length; ++i) {
        Random random(seed, std::uint64_t(i));
        Lanes real, imaginary;
        for (int lane = 0; lane < Lanes::kCount; ++lane) {
            real.values[lane] = float(random.uniform(-1, 1));
            imaginary.values[lane] = float(random.uniform(-1, 1));
        }
        lines.emplace_back(real, imaginary);
    }
    return lines;
}

Complex at(const std::vector<ComplexLanes>& lines, int i, int lane) {
    const ComplexLanes& value = lines[std::size_t(i)];
    return {double(value.real().values[lane]), double(value.imag().values[lane])};
}

Complex sumByHand(const std::vector<ComplexLanes>& lines, int k, int lane) {
    const int length = int(lines.size());
    Complex sum = 0;
    for (int i = 0; i < length; ++i)
        sum += at(lines, i, lane) *
               std::polar(1.0, -2 * 3.14159265358979323846 * double(i * k % length) / double(length));
    return sum;
}

}  // namespace

TEST_CASE("LineTransform: the sum of its definition, in every lane, off by no more than is said",
          "[math][oracle]") {
    for (int length : {1, 2, 3, 4, 5, 6, 8, 15, 27, 64, 90, 128, 225}) {
        INFO("length " << length);
        const LineTransform transform(length);
        CHECK(transform.length() == length);
        const std::vector<ComplexLanes> in = randomLines(length, 3);
        std::vector<ComplexLanes> out(in.size());
        transform.run(in.data(), out.data());
        for (int lane = 0; lane < Lanes::kCount; ++lane) {
            double off = 0, norm = 0;
            for (int k = 0; k < length; ++k) {
                const Complex exact = sumByHand(in, k, lane);
                off += std::norm(at(out, k, lane) - exact);
                norm += std::norm(exact);
            }
            CHECK(std::sqrt(off) <= transformRounding(length) * std::sqrt(norm));
        }
    }
}

TEST_CASE("LineTransform: there and back again is the length times the line, turned round",
          "[math][property]") {
    const int length = 60;
    const LineTransform transform(length);
    const std::vector<ComplexLanes> in = randomLines(length, 5);
    std::vector<ComplexLanes> there(in.size()), back(in.size());
    transform.run(in.data(), there.data());
    transform.run(there.data(), back.data());
    for (int i = 0; i < length; ++i)
        for (int lane = 0; lane < Lanes::kCount; ++lane)
            REQUIRE(std::abs(at(back, (length - i) % length, lane) / double(length) - at(in, i, lane)) <
                    1e-6);
}

TEST_CASE("transformLength: the least length without a factor over 5", "[math][fast]") {
    CHECK(transformLength(1) == 1);
    CHECK(transformLength(7) == 8);
    CHECK(transformLength(11) == 12);
    CHECK(transformLength(64) == 64);
    CHECK(transformLength(241) == 243);
    CHECK(transformLength(257) == 270);
}

TEST_CASE("transformRounding: grows with the number of factors of two", "[math][fast]") {
    CHECK(transformRounding(1) == 0);
    CHECK(transformRounding(256) == Approx(8 * transformRounding(2)));
    CHECK(transformRounding(300) > transformRounding(256));
}
