#pragma once
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/coordinates/sample_image.h"

namespace vdbsynth::test {

/// Independent grey values, evenly distributed.
inline SampleImage noiseSample(int width, int height, std::uint64_t seed = 1) {
    SampleImage image{width, height, 1, false, {}};
    for (std::size_t i = 0; i < image.texels(); ++i) image.values.push_back(float(Random(seed, i).uniform()));
    return image;
}

/// Vertical stripes of the given width, black and white, with a little noise.
inline SampleImage stripesSample(int side, int stripe) {
    SampleImage image{side, side, 1, false, {}};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            image.values.push_back(float((x / stripe) % 2) * 0.9f +
                                   float(Random(3, std::uint64_t(y * side + x)).uniform(0, 0.1)));
    return image;
}

}  // namespace vdbsynth::test
