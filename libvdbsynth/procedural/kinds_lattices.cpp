// The kinds that are lists of primitives on a perturbed lattice. Every random number is keyed on the
// lattice site, so a larger domain with the same seed begins with the smaller one's geometry.
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/math/lattice.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/procedural/kinds.h"
#include "libvdbsynth/procedural/packing.h"

#include <cmath>

namespace vdbsynth {
namespace {

enum Purpose : std::uint32_t { kNode = 1, kRing = 2, kFibre = 3, kYarn = 4, kPhase = 5, kFlower = 6 };

std::uint64_t siteKey(int i, int j, int k = 0) {
    return std::uint64_t(std::uint32_t(i + 100000) & 0x1FFFFF) << 42 |
           std::uint64_t(std::uint32_t(j + 100000) & 0x1FFFFF) << 21 |
           std::uint64_t(std::uint32_t(k + 100000) & 0x1FFFFF);
}

int firstSite(int low, double spacing) {
    return int(std::floor(low / spacing)) - 1;
}
int lastSite(int high, double spacing) {
    return int(std::ceil(high / spacing)) + 1;
}

// A lattice that starts at a random phase, so that seeds differ in it too.
Vec3d phaseOf(const ExemplarRequest& request) {
    Random random(request.seed, 0, kPhase);
    return Vec3d{random.uniform(), random.uniform(), random.uniform()} * request.feature;
}

Vec3d jitter(Random& random, double by) {
    return {random.uniform(-by, by), random.uniform(-by, by), random.uniform(-by, by)};
}

}  // namespace

std::vector<Primitive> ballsPrimitives(const ExemplarRequest& request, const RunContext& ctx) {
    const double radius = request.feature / 2;
    Vec3d low, high;
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = request.box.min[axis] - radius;
        high[axis] = request.box.max[axis] + radius;
    }
    std::vector<Primitive> primitives;
    for (const PackedBall& packed : packBalls(low, high, 0.8 * radius, radius, 0.56, request.seed, ctx))
        primitives.push_back(ball(packed.centre, packed.radius));
    return primitives;
}

std::vector<Primitive> gridPrimitives(const ExemplarRequest& request) {
    const double f = request.feature;
    const Vec3d phase = phaseOf(request);
    struct Node {
        Vec3d position;
        double ball, bar[3];
    };
    const auto nodeAt = [&](const Index3& site) {
        Random random(request.seed, siteKey(site.x, site.y, site.z), kNode);
        Node node;
        node.position = Vec3d{site.x * f, site.y * f, site.z * f} + phase + jitter(random, 0.08 * f);
        node.ball = f * random.uniform(0.24, 0.32);
        for (double& bar : node.bar) bar = f * random.uniform(0.11, 0.15);
        return node;
    };
    IndexBox sites;
    for (int axis = 0; axis < 3; ++axis) {
        sites.min[axis] = firstSite(request.box.min[axis], f) - 1;
        sites.max[axis] = lastSite(request.box.max[axis], f);
    }
    std::vector<Primitive> primitives;
    forEachVoxel(sites, [&](const Index3& site) {
        const Node node = nodeAt(site);
        primitives.push_back(ball(node.position, node.ball));
        for (int axis = 0; axis < 3; ++axis) {
            Index3 next = site;
            ++next[axis];
            primitives.push_back(capsule(node.position, nodeAt(next).position, node.bar[axis]));
        }
    });
    return primitives;
}

// Flat rings on a square lattice, upright rings that link each to its neighbours ("Japanese" mail). Between
// any two rings are at least 0.085 features, jitter included: two voxels of the default feature, so that
// none fuse.
std::vector<Primitive> chainmailPrimitives(const ExemplarRequest& request) {
    const double f = request.feature;
    const Vec3d phase = phaseOf(request);
    const double middle = 0.5 * (request.domain.min.z + request.domain.max.z);
    const double tube = 0.05 * f;
    std::vector<Primitive> primitives;
    const auto add = [&](Random& random, Vec3d centre, Vec3d axis, double ring) {
        axis = axis + jitter(random, 0.03);
        primitives.push_back(torus(centre + jitter(random, 0.006 * f), axis, ring * f, tube));
    };
    for (int i = firstSite(request.box.min.x, f) - 1; i <= lastSite(request.box.max.x, f); ++i)
        for (int j = firstSite(request.box.min.y, f) - 1; j <= lastSite(request.box.max.y, f); ++j) {
            Random random(request.seed, siteKey(i, j), kRing);
            const Vec3d centre{i * f + phase.x, j * f + phase.y, middle};
            add(random, centre, {0, 0, 1}, 0.40);
            add(random, centre + Vec3d{0.5 * f, 0, 0}, {0, 1, 0}, 0.31);
            add(random, centre + Vec3d{0, 0.5 * f, 0}, {1, 0, 0}, 0.31);
        }
    return primitives;
}

namespace {

// Five petals that rise towards their tips, round a button on a short stem; `axis` points up, `s` is the
// flower's size. Nothing reaches farther than 0.38 s from the axis.
void addFlower(const Vec3d& centre, const Vec3d& axis, double s, Random& random,
               std::vector<Primitive>& primitives) {
    constexpr int kPetals = 5;
    const Vec3d u = normalized(cross(axis, {0, 1, 0})), v = cross(axis, u);
    const double turn = random.uniform();
    primitives.push_back(ball(centre + axis * (0.03 * s), 0.12 * s));
    primitives.push_back(capsule(centre, centre - axis * (0.24 * s), 0.065 * s));
    for (int petal = 0; petal < kPetals; ++petal) {
        const double angle = 2 * kPi * (petal + turn + random.uniform(-0.06, 0.06)) / kPetals;
        const auto outwards = [&](double by) { return u * cosine(angle + by) + v * sine(angle + by); };
        const double rise = random.uniform(0.10, 0.15);
        const Vec3d bend = centre + (outwards(0) * 0.18 + axis * 0.03) * s;
        primitives.push_back(capsule(centre, bend, 0.075 * s));
        // A petal widens: it has two tips.
        for (const double side : {-0.2, 0.2})
            primitives.push_back(capsule(bend, centre + (outwards(side) * 0.31 + axis * rise) * s, 0.07 * s));
    }
}

}  // namespace

// Loose flowers in staggered rows; none touches another.
std::vector<Primitive> flowersPrimitives(const ExemplarRequest& request) {
    const double f = request.feature, row = 0.87 * f;
    const Vec3d phase = phaseOf(request);
    const double middle = 0.5 * (request.domain.min.z + request.domain.max.z);
    std::vector<Primitive> primitives;
    for (int j = firstSite(request.box.min.y, row) - 1; j <= lastSite(request.box.max.y, row); ++j)
        for (int i = firstSite(request.box.min.x, f) - 1; i <= lastSite(request.box.max.x, f); ++i) {
            Random random(request.seed, siteKey(i, j), kFlower);
            const Vec3d centre{(i + (j & 1) * 0.5) * f + phase.x, j * row + phase.y, middle};
            const Vec3d axis = normalized(Vec3d{0, 0, 1} + jitter(random, 0.25));
            addFlower(centre + jitter(random, 0.05 * f), axis, f * random.uniform(0.85, 1), random,
                      primitives);
        }
    return primitives;
}

std::vector<Primitive> fibresPrimitives(const ExemplarRequest& request) {
    const double f = request.feature;
    const Vec3d phase = phaseOf(request);
    std::vector<Primitive> primitives;
    for (int j = firstSite(request.box.min.y, f) - 1; j <= lastSite(request.box.max.y, f); ++j)
        for (int k = firstSite(request.box.min.z, f) - 1; k <= lastSite(request.box.max.z, f); ++k) {
            Random random(request.seed, siteKey(j, k), kFibre);
            const double y = (j + (k & 1) * 0.5) * f + phase.y + random.uniform(-0.08, 0.08) * f;
            const double z = k * 0.87 * f + phase.z + random.uniform(-0.08, 0.08) * f;
            const double radius = f * random.uniform(0.20, 0.27);
            const double swing = f * random.uniform(0.10, 0.18), turn = 2 * kPi * random.uniform();
            const double wave = 2 * kPi / (f * random.uniform(2.6, 3.4)), drift = random.uniform(0.3, 1.2);
            const auto at = [&](double x) {
                return Vec3d{x, y + swing * sine(wave * x + turn),
                             z + swing * cosine(wave * x * drift + turn)};
            };
            const double step = f / 8;  // chord error under 0.2 % of the feature
            for (double x = request.box.min.x - step; x < request.box.max.x + step; x += step)
                primitives.push_back(capsule(at(x), at(x + step), radius));
        }
    return primitives;
}

// As large as the domain allows with a tenth of it free at every side, for textures that are added.
std::vector<Primitive> threeToriPrimitives(const ExemplarRequest& request) {
    const Index3 size = request.domain.size();
    const double side = std::min({size.x, size.y, size.z});
    Vec3d middle;
    for (int axis = 0; axis < 3; ++axis) middle[axis] = (size[axis] - 1) / 2.0;
    std::vector<Primitive> primitives;
    for (int axis = 0; axis < 3; ++axis) {
        Random random(request.seed, std::uint64_t(axis), kYarn);
        Vec3d along{random.uniform(-0.06, 0.06), random.uniform(-0.06, 0.06), random.uniform(-0.06, 0.06)};
        along[axis] = 1;
        const double tube = side * random.uniform(0.095, 0.105);
        primitives.push_back(torus(middle, normalized(along), 0.4 * side - tube, tube));
    }
    return primitives;
}

std::vector<Primitive> weavePrimitives(const ExemplarRequest& request) {
    const double f = request.feature;
    const Vec3d phase = phaseOf(request);
    const double middle = 0.5 * (request.domain.min.z + request.domain.max.z);
    std::vector<Primitive> primitives;
    for (int along = 0; along < 2; ++along) {
        const int across = 1 - along;
        for (int j = firstSite(request.box.min[across], f) - 1; j <= lastSite(request.box.max[across], f);
             ++j) {
            Random random(request.seed, siteKey(along, j), kYarn);
            const double side = j * f + phase[across] + random.uniform(-0.05, 0.05) * f;
            const double radius = f * random.uniform(0.21, 0.24), lift = f * random.uniform(0.24, 0.27);
            const double sway = f * random.uniform(0.0, 0.05), turn = 2 * kPi * random.uniform();
            const double sign = ((j & 1) == along) ? 1 : -1;
            const auto at = [&](double t) {
                Vec3d p;
                p[along] = t;
                p[across] = side + sway * sine(2 * kPi * (t - phase[along]) / (4.3 * f) + turn);
                p.z = middle + sign * lift * cosine(kPi * (t - phase[along]) / f);
                return p;
            };
            const double step = f / 10;
            for (double t = request.box.min[along] - step; t < request.box.max[along] + step; t += step)
                primitives.push_back(capsule(at(t), at(t + step), radius));
        }
    }
    return primitives;
}

}  // namespace vdbsynth
