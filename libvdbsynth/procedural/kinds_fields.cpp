// The kinds that are fields: Voronoi foam, a random field's level set, a height field.
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/procedural/kinds.h"
#include "libvdbsynth/procedural/packing.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr std::uint32_t kWavePurpose = 0x77617665, kBumpPurpose = 0x62756d70;
constexpr int kSide = BrickField::kSide;

struct Wave {
    Vec3d vector;  // [radians / voxel]
    double phase, amplitude;
};

Vec3d randomDirection(Random& random, bool flat) {
    if (flat) {
        const double angle = 2 * kPi * random.uniform();
        return {cosine(angle), sine(angle), 0};
    }
    for (;;) {
        const Vec3d v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        const double l = length(v);
        if (l > 0.1 && l < 1) return v * (1 / l);
    }
}

double sumOf(const std::vector<Wave>& waves, const Vec3d& p) {
    double sum = 0;
    for (const Wave& wave : waves) sum += wave.amplitude * cosine(dot(wave.vector, p) + wave.phase);
    return sum;
}

std::uint64_t bumpKey(int i, int j) {
    return std::uint64_t(std::uint32_t(i)) << 32 | std::uint32_t(j);
}

}  // namespace

// Distance to the walls of the Voronoi cells of packed seeds: within a convex cell the nearest wall is
// that of the nearest bisector, so the distance is exact in the voids.
BrickField foamField(const ExemplarRequest& request, const RunContext& ctx) {
    const double f = request.feature, wall = std::max(1.2, 0.07 * f);
    Vec3d low, high;
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = request.box.min[axis] - 1.5 * f;
        high[axis] = request.box.max[axis] + 1.5 * f;
    }
    const std::vector<PackedBall> seeds = packBalls(low, high, 0.42 * f, 0.5 * f, 0.5, request.seed, ctx);
    return BrickField::generate(request.box, ctx, [&](const IndexBox& brick, float* samples) {
        const Vec3d middle{brick.min.x + 3.5, brick.min.y + 3.5, brick.min.z + 3.5};
        // No point is farther than 1.3 features from its seed in these packings; its cell's neighbours are
        // within twice that.
        std::vector<Vec3d> near;
        for (const PackedBall& seed : seeds)
            if (length(seed.centre - middle) < 2.7 * f + 7) near.push_back(seed.centre);
        std::sort(near.begin(), near.end(), [&](const Vec3d& a, const Vec3d& b) {
            return dot(a - middle, a - middle) < dot(b - middle, b - middle);
        });
        forEachVoxel(brick, [&](const Index3& voxel) {
            const Vec3d p{double(voxel.x), double(voxel.y), double(voxel.z)};
            std::size_t own = 0;
            for (std::size_t i = 1; i < near.size(); ++i)
                if (dot(near[i] - p, near[i] - p) < dot(near[own] - p, near[own] - p)) own = i;
            double nearest = double(kExemplarLimit) + wall;
            for (std::size_t i = 0; i < near.size(); ++i) {
                if (i == own) continue;
                const Vec3d apart = near[i] - near[own];
                nearest = std::min(nearest, dot((near[i] + near[own]) * 0.5 - p, apart) / length(apart));
            }
            *samples++ = float(std::clamp(nearest - wall, -double(kExemplarLimit), double(kExemplarLimit)));
        });
    });
}

// A sum of 48 plane waves of about one wavelength, nearly a Gaussian field; solid
// where it is above 0.1 sigma.
std::function<double(const Vec3d&)> spongeSurface(const ExemplarRequest& request) {
    std::vector<Wave> waves;
    constexpr int kWaves = 48;
    for (std::uint64_t i = 0; i < kWaves; ++i) {
        Random random(request.seed, i, kWavePurpose);
        const Vec3d direction = randomDirection(random, false);
        const double k = 2 * kPi / (request.feature * random.uniform(0.8, 1.25));
        waves.push_back({direction * k, 2 * kPi * random.uniform(), std::sqrt(2.0 / kWaves)});
    }
    const double slope = 2 * kPi / request.feature;  // turns the field's values into voxels near its zero
    return [waves, slope](const Vec3d& p) { return (0.1 - sumOf(waves, p)) / slope; };
}

BrickField spongeField(const ExemplarRequest& request, const RunContext& ctx) {
    const auto surface = spongeSurface(request);
    return BrickField::fromVoxels(request.box, ctx, [&](const Index3& voxel) {
        const double value = surface({double(voxel.x), double(voxel.y), double(voxel.z)});
        return float(std::clamp(value, -double(kExemplarLimit), double(kExemplarLimit)));
    });
}

BrickField heightsField(const ExemplarRequest& request, const Heights& heightAt, const RunContext& ctx) {
    const int nx = request.box.size().x, ny = request.box.size().y;
    const int wide = (nx + kSide - 1) / kSide * kSide, deep = (ny + kSide - 1) / kSide * kSide;
    // One height per column; bricks of one column share them.
    std::vector<double> heights(std::size_t(wide) * std::size_t(deep));
    for (int x = 0; x < wide; ++x)
        for (int y = 0; y < deep; ++y)
            heights[std::size_t(x) * std::size_t(deep) + std::size_t(y)] =
                heightAt(double(request.box.min.x + x), double(request.box.min.y + y));
    return BrickField::generate(request.box, ctx, [&](const IndexBox& brick, float* samples) {
        for (int x = 0; x < kSide; ++x)
            for (int y = 0; y < kSide; ++y) {
                const double top =
                    heights[std::size_t(brick.min.x - request.box.min.x + x) * std::size_t(deep) +
                            std::size_t(brick.min.y - request.box.min.y + y)];
                for (int z = 0; z < kSide; ++z)
                    *samples++ = float(
                        std::clamp(brick.min.z + z - top, -double(kExemplarLimit), double(kExemplarLimit)));
            }
    });
}

// Five octaves of sixteen waves; each octave has half the wavelength and 0.45 of the height.
Heights terrainHeights(const ExemplarRequest& request) {
    std::vector<Wave> waves;
    constexpr int kWaves = 16, kOctaves = 5;
    double wavelength = request.feature, height = 0.16 * request.feature;
    for (int octave = 0; octave < kOctaves && wavelength >= 3; ++octave, wavelength /= 2, height *= 0.45)
        for (int i = 0; i < kWaves; ++i) {
            Random random(request.seed, std::uint64_t(octave * kWaves + i), kWavePurpose + 1);
            const Vec3d direction = randomDirection(random, true);
            const double k = 2 * kPi / (wavelength * random.uniform(0.75, 1.3));
            waves.push_back({direction * k, 2 * kPi * random.uniform(), height * std::sqrt(2.0 / kWaves)});
        }
    const double level = request.domain.min.z + 0.5 * request.domain.size().z;
    return [waves, level](double x, double y) { return level + sumOf(waves, {x, y, 0}); };
}

// Round bumps in staggered rows, (1 - r^2 / R^2)^2 high, which add up where they overlap.
Heights bumpsHeights(const ExemplarRequest& request) {
    const double f = request.feature, row = 0.87 * f;
    const double level = request.domain.min.z + 0.35 * request.domain.size().z;
    Random phases(request.seed, 0, kBumpPurpose);
    const double phaseX = f * phases.uniform(), phaseY = f * phases.uniform();
    return [=, seed = request.seed](double x, double y) {
        const auto siteOf = [](double place, double step) { return int(std::floor(place / step)); };
        double height = 0;
        const int row0 = siteOf(y - phaseY, row), column0 = siteOf(x - phaseX, f);
        // No bump reaches farther than 0.63 features from its site.
        for (int j = row0 - 1; j <= row0 + 2; ++j)
            for (int i = column0 - 2; i <= column0 + 2; ++i) {
                Random random(seed, bumpKey(i, j), kBumpPurpose + 1);
                const double atX = phaseX + (i + (j & 1) * 0.5) * f + random.uniform(-0.08, 0.08) * f;
                const double atY = phaseY + j * row + random.uniform(-0.08, 0.08) * f;
                const double reach = f * random.uniform(0.42, 0.55), top = f * random.uniform(0.18, 0.3);
                const double rest = 1 - ((x - atX) * (x - atX) + (y - atY) * (y - atY)) / (reach * reach);
                if (rest > 0) height += top * rest * rest;
            }
        return level + height;
    };
}

}  // namespace vdbsynth
