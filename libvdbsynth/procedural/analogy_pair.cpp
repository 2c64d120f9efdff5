#include "libvdbsynth/procedural/analogy_pair.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/base/random.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/procedural/packing.h"
#include "libvdbsynth/procedural/primitives.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace vdbsynth {
namespace {

using Shape = std::function<double(const Vec3d&)>;

constexpr std::uint32_t kGroovePurpose = 0x67726f76, kPlacePurpose = 0x706c6163;

BrickField fieldOf(const IndexBox& domain, const Shape& shape, const RunContext& ctx) {
    const IndexBox box = domain.expanded(kExemplarMargin);
    return BrickField::fromVoxels(box, ctx, [&](const Index3& p) {
        return float(std::clamp(shape({double(p.x), double(p.y), double(p.z)}), -double(kExemplarLimit),
                                double(kExemplarLimit)));
    });
}

AnalogyPairFields pairOf(const IndexBox& domain, const Shape& plain, const Shape& textured,
                         const RunContext& ctx) {
    AnalogyPairFields pair;
    for (auto [field, shape] : {std::pair{&pair.plain, &plain}, std::pair{&pair.textured, &textured}}) {
        field->domain = domain;
        field->exact = false;
        field->field = fieldOf(domain, *shape, ctx);
    }
    return pair;
}

// A cylinder along z, and one with grooves along it, each a little wider or deeper than the next.
AnalogyPairFields grooves(int resolution, double feature, const RunContext& ctx) {
    const double middle = (resolution - 1) / 2.0, radius = resolution / 2.0 - 8;
    const int count = std::max(3, int(std::lround(2 * kPi * radius / feature)));
    std::vector<double> ends, depths;
    Random random(ctx.seed, 0, kGroovePurpose);
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        ends.push_back(sum += random.uniform(0.85, 1.15));
        depths.push_back(0.36 * feature * random.uniform(0.9, 1.1));
    }
    const double first = random.uniform();
    const auto radial = [=](const Vec3d& p) {
        return std::sqrt((p.x - middle) * (p.x - middle) + (p.y - middle) * (p.y - middle));
    };
    const Shape plain = [=](const Vec3d& p) { return radial(p) - radius; };
    const Shape grooved = [=](const Vec3d& p) {
        const double turn = arcTangent(p.y - middle, p.x - middle) / (2 * kPi) + first;
        const double at = (turn - std::floor(turn)) * sum;
        const std::size_t i = std::min<std::size_t>(
            std::size_t(std::upper_bound(ends.begin(), ends.end(), at) - ends.begin()), ends.size() - 1);
        const double begin = i ? ends[i - 1] : 0, u = (at - begin) / (ends[i] - begin);
        return radial(p) - radius + depths[i] * (0.5 - 0.5 * cosine(2 * kPi * u));
    };
    return pairOf(IndexBox::fromSize({resolution, resolution, resolution * 3 / 2}), plain, grooved, ctx);
}

// Positions on a plane, one in each cell of a grid, jittered.
struct Places {
    Places(int resolution, double wanted, std::uint64_t seed)
        : count(std::max(2, int(std::lround(resolution / wanted)))), spacing(double(resolution) / count) {
        for (int i = 0; i < count * count; ++i) {
            Random random(seed, std::uint64_t(i), kPlacePurpose);
            const double shift = (i / count % 2) * 0.5;  // rows half a cell apart
            x.push_back((i / count + 0.5 + random.uniform(-0.08, 0.08)) * spacing);
            y.push_back((i % count + 0.25 + shift + random.uniform(-0.08, 0.08)) * spacing);
        }
    }
    // Offset to the nearest position; the pattern continues beyond the domain.
    Vec3d nearest(const Vec3d& p) const {
        Vec3d best{1e9, 1e9, 0};
        const int row = int(std::floor(p.x / spacing)), column = int(std::floor(p.y / spacing));
        for (int a = row - 1; a <= row + 1; ++a)
            for (int b = column - 2; b <= column + 2; ++b) {
                const int ra = (a % count + count) % count, rb = (b % count + count) % count;
                const std::size_t i = std::size_t(ra * count + rb);
                const Vec3d offset{p.x - x[i] - (a - ra) * spacing, p.y - y[i] - (b - rb) * spacing, 0};
                if (length(offset) < length(best)) best = offset;
            }
        return best;
    }
    int count;
    double spacing;
    std::vector<double> x, y;
};

// Plates in rows like roof tiles: each lies along x, is thinnest at its root, which the tip of the plate
// behind it covers, and ends in a rounded tip with a steep edge.
class Scales {
public:
    Scales(int resolution, double wanted, std::uint64_t seed)
        : mColumns(std::max(2, int(std::lround(resolution / wanted)))),
          // An even number of rows, so that those half a plate apart meet where the pattern begins again.
          mRows(2 * std::max(2, int(std::lround(resolution / (1.5 * wanted))))),
          mWidth(double(resolution) / mColumns),
          mStep(double(resolution) / mRows),
          mSeed(seed) {}

    // From the plates' surfaces; z counts from the plain one.
    double distance(double x, double y, double z) const {
        const int row = int(std::floor(x / mStep));
        double nearest = z;
        for (int r = row - 3; r <= row + 1; ++r) {
            const double shift = r % 2 ? 0.5 : 0.0;
            const int column = int(std::floor(y / mWidth - shift));
            for (int c = column - 1; c <= column + 1; ++c)
                nearest = std::min(nearest, plate(r, c, {x - r * mStep, y - (c + 0.5 + shift) * mWidth, z}));
        }
        return nearest;
    }

private:
    static constexpr double kLength = 2.1;  // [rows] of a plate

    // Distance to one plate: p.x along it from its root, p.y beside its middle.
    double plate(int row, int column, Vec3d p) const {
        const int r = (row % mRows + mRows) % mRows, c = (column % mColumns + mColumns) % mColumns;
        Random random(mSeed, std::uint64_t(r * mColumns + c), kPlacePurpose);
        p.x -= mStep * random.uniform(-0.06, 0.06);
        p.y -= mWidth * random.uniform(-0.03, 0.03);
        const double longest = kLength * mStep, half = 0.56 * mWidth, tallest = 0.34 * mWidth;
        // Sides run straight to the last half width, then close to an ellipse.
        const double tip = std::min(half, 0.6 * longest), beside = p.y / half,
                     past = std::max(0.0, (p.x - (longest - tip)) / tip);
        const double edge = (std::sqrt(past * past + beside * beside) - 1) * tip;
        const double top = tallest * (p.x / longest) * (1 - 0.35 * std::min(beside * beside, 1.0));
        return std::max({p.z - top, edge, -p.x});
    }

    int mColumns, mRows;
    double mWidth, mStep;
    std::uint64_t mSeed;
};

// A slab that continues below, and a textured version of its top.
AnalogyPairFields slab(const std::string& kind, int resolution, double feature, const RunContext& ctx) {
    const Places places(resolution, feature, ctx.seed);
    Random random(ctx.seed, 1, kPlacePurpose);
    const double f = places.spacing, top = std::ceil(2.2 * feature),
                 wall = std::max(4.0, 0.4 * feature) + random.uniform(-0.4, 0.4);
    const IndexBox domain = IndexBox::fromSize({resolution, resolution, int(top + 2.2 * feature)});
    const Shape plain = [=](const Vec3d& p) { return p.z - top; };
    Shape textured;
    if (kind == "spikes")
        textured = [=](const Vec3d& p) {
            const double share = std::clamp((p.z - top) / (0.9 * f), 0.0, 1.0);
            const double cone = length(places.nearest(p)) - 0.36 * f * (1 - share);
            return std::min(p.z - top, p.z > top + 0.9 * f ? p.z - top - 0.9 * f + 0.5 : cone);
        };
    else if (kind == "pits")
        textured = [=](const Vec3d& p) {
            const Vec3d offset = places.nearest(p) + Vec3d{0, 0, p.z - top};
            return std::max(p.z - top, 0.36 * f - length(offset));
        };
    else if (kind == "holes")
        textured = [=](const Vec3d& p) {
            const double plate = std::max(p.z - top, top - wall - p.z);
            return std::max(plate, 0.3 * f - length(places.nearest(p)));
        };
    else if (kind == "hollow")
        textured = [=](const Vec3d& p) { return std::max(p.z - top, top - wall - p.z); };
    else
        textured = [scales = Scales(resolution, feature, ctx.seed), top](const Vec3d& p) {
            return scales.distance(p.x, p.y, p.z - top);
        };
    return pairOf(domain, plain, textured, ctx);
}

// A ball, and the same with thorns that curl along z.
AnalogyPairFields thorns(int resolution, double feature, const RunContext& ctx) {
    const double radius = resolution / 2.0 - 6 - 0.8 * feature;
    const Vec3d middle{(resolution - 1) / 2.0, (resolution - 1) / 2.0, (resolution - 1) / 2.0};
    std::vector<Primitive> primitives{ball(middle, radius)};
    const int rings = std::max(3, int(std::lround(kPi * radius / feature)));
    for (int ring = 1; ring < rings; ++ring) {
        const double polar = kPi * ring / rings;
        const int count = std::max(3, int(std::lround(2 * kPi * radius * sine(polar) / feature)));
        Random random(ctx.seed, std::uint64_t(ring), kPlacePurpose);
        const double first = random.uniform();
        for (int i = 0; i < count; ++i) {
            const double turn = 2 * kPi * (i + first + random.uniform(-0.1, 0.1)) / count;
            const Vec3d n{sine(polar) * cosine(turn), sine(polar) * sine(turn), cosine(polar)};
            const Vec3d t = normalized(Vec3d{0, 0, 1} - n * n.z);
            const int steps = 8;
            Vec3d last;
            for (int k = 0; k <= steps; ++k) {
                const double s = double(k) / steps;
                const Vec3d at = middle + n * (radius + 0.75 * feature * s * (1 - 0.25 * s)) +
                                 t * (0.55 * feature * s * s);
                const double thick = std::max(0.9, 0.2 * feature * (1 - 0.8 * s));
                if (k > 0) primitives.push_back(capsule(last, at, thick));
                last = at;
            }
        }
    }
    const IndexBox domain = IndexBox::fromSize({resolution, resolution, resolution});
    AnalogyPairFields pair;
    pair.plain.domain = pair.textured.domain = domain;
    pair.plain.exact = pair.textured.exact = false;
    pair.plain.field =
        unionField({primitives.front()}, domain.expanded(kExemplarMargin), kExemplarLimit, ctx);
    pair.textured.field = unionField(primitives, domain.expanded(kExemplarMargin), kExemplarLimit, ctx);
    return pair;
}

// A ball, and one that is a third of a feature larger.
AnalogyPairFields dilation(int resolution, double feature, const RunContext& ctx) {
    const double more = feature / 3, radius = resolution / 2.0 - 6 - more;
    Random random(ctx.seed, 0, kPlacePurpose);
    Vec3d middle;
    for (int axis = 0; axis < 3; ++axis) middle[axis] = (resolution - 1) / 2.0 + random.uniform(-0.5, 0.5);
    return pairOf(
        IndexBox::fromSize({resolution, resolution, resolution}),
        [=](const Vec3d& p) { return length(p - middle) - radius; },
        [=](const Vec3d& p) { return length(p - middle) - radius - more; }, ctx);
}

}  // namespace

const std::vector<AnalogyPairKind>& analogyPairKinds() {
    static const std::vector<AnalogyPairKind> kinds{
        {"grooves", "a cylinder, and one with grooves along it", "axis:z", 10},
        {"spikes", "a slab, and one with cones", "axis:x", 14},
        {"pits", "a slab, and one with round pits", "axis:x", 14},
        {"holes", "a slab, and a plate with holes through it", "axis:x", 14},
        {"hollow", "a slab, and a plate", "axis:x", 12},
        {"scales", "a slab, and one with overlapping scales", "axis:x", 16},
        {"thorns", "a ball, and one with thorns that curl", "axis:z", 14},
        {"dilation", "a ball, and a larger one", "axis:z", 12},
    };
    return kinds;
}

namespace {

const AnalogyPairKind& findPairKind(const std::string& name) {
    const auto& kinds = analogyPairKinds();
    const auto kind =
        std::find_if(kinds.begin(), kinds.end(), [&](const AnalogyPairKind& k) { return k.name == name; });
    if (kind == kinds.end())
        throw Error(ErrorCode::InvalidOption, "make " + name + ": no pair has that name");
    return *kind;
}

}  // namespace

void validatePair(const ExemplarOptions& options) {
    const AnalogyPairKind& kind = findPairKind(options.kind);
    requireOption(options.feature == 0 || (options.feature >= 6 && options.feature <= 256), "feature",
                  roundedText(options.feature, 6), "from 6 to 256 voxels");
    const double feature = options.feature > 0 ? options.feature : kind.feature;
    requireOption(
        options.resolution >= 4 * feature && options.resolution <= 4096, "resolution",
        std::to_string(options.resolution),
        "at least four features (" + std::to_string(int(std::ceil(4 * feature))) + ") and at most 4096");
}

AnalogyPairFields makeAnalogyPair(const ExemplarOptions& options, const RunContext& ctx) {
    validatePair(options);
    const AnalogyPairKind* kind = &findPairKind(options.kind);
    const double feature = options.feature > 0 ? options.feature : kind->feature;
    requireMemory(ctx, double(options.resolution) * options.resolution * options.resolution * 24,
                  "make " + kind->name, "use a smaller `resolution`");
    Stage stage(ctx, "make " + kind->name, 1);
    AnalogyPairFields pair = kind->name == "grooves"    ? grooves(options.resolution, feature, ctx)
                             : kind->name == "thorns"   ? thorns(options.resolution, feature, ctx)
                             : kind->name == "dilation" ? dilation(options.resolution, feature, ctx)
                                                        : slab(kind->name, options.resolution, feature, ctx);
    pair.direction = kind->direction;
    stage.advance();
    return pair;
}

}  // namespace vdbsynth
