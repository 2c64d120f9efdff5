#pragma once
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/texture/surface_texture.h"
#include "tests/support/makers.h"
#include "tests/support/point_shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>

// Targets and samples shared by the tests of this room.
namespace vdbsynth::test {

/// Checks that `call` with options that `change` spoils is refused by the name of the field.
template <typename Options, typename Call, typename Change>
void requireRefused(const Call& call, const char* field, const Change& change) {
    Options options;
    change(options);
    const Thrown thrown = thrownBy([&] { call(options); });
    CHECK(thrown.code == int(ErrorCode::InvalidOption));
    CHECK(thrown.message.find(field) != std::string::npos);
}

inline TextureTarget targetOf(const PointShape& shape) {
    return {shape.point, shape.normal, {}, {}};
}

/// Points of a square lattice of side `step`, each moved at random by at most 0.35 of it, rolled up: x runs
/// along the axis of a cylinder of radius 1, y is the angle.
inline PointShape rolledSheet(double length, double angle, double step, std::uint64_t seed = 1) {
    PointShape shape;
    for (double x = 0; x < length; x += step)
        for (double y = 0; y < angle; y += step) {
            Random random(seed, shape.point.size());
            const double a = y + step * random.uniform(-0.35, 0.35);
            shape.point.push_back(
                {float(x + step * random.uniform(-0.35, 0.35)), float(std::sin(a)), float(std::cos(a))});
            shape.normal.push_back({0, float(std::sin(a)), float(std::cos(a))});
        }
    return shape;
}

/// Independent values in 0..1.
inline SampleImage noiseSample(int side, int channels, bool tileable, std::uint64_t seed = 3) {
    SampleImage image{side, side, channels, tileable, {}};
    for (std::size_t i = 0; i < image.texels() * std::size_t(channels); ++i)
        image.values.push_back(float(Random(seed, i).uniform()));
    return image;
}

/// Noise smoothed over a few texels, in range 0..1 with varied channels.
inline SampleImage cloudSample(int side, int channels, bool tileable, std::uint64_t seed = 4) {
    const SampleImage noise = noiseSample(side, channels, true, seed);
    SampleImage image = noise;
    image.tileable = tileable;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int c = 0; c < channels; ++c) {
                float sum = 0;
                for (int j = -1; j <= 1; ++j)
                    for (int i = -1; i <= 1; ++i)
                        sum += noise.texel((x + i + side) % side, (y + j + side) % side)[c];
                image.values[(std::size_t(y) * std::size_t(side) + std::size_t(x)) * std::size_t(channels) +
                             std::size_t(c)] = sum / 9;
            }
    return image;
}

/// Standard deviation over all values of one channel.
inline double contrast(const std::vector<float>& values, std::size_t channels, std::size_t channel) {
    double sum = 0, squares = 0;
    const std::size_t n = values.size() / channels;
    for (std::size_t i = 0; i < n; ++i) {
        const double v = double(values[i * channels + channel]);
        sum += v;
        squares += v * v;
    }
    return std::sqrt(std::max(0.0, squares / double(n) - sum / double(n) * sum / double(n)));
}

}  // namespace vdbsynth::test
