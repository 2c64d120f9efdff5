// Answers about a ball of bumps: its base and relief together, laid on its own base, on a plain ball.
#include "libvdbsynth/coordinates/site_chart.h"
#include "libvdbsynth/distance/widen_band.h"
#include "libvdbsynth/distance/zero_level.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/math/trigonometry.h"
#include "libvdbsynth/pipeline/relief/relief_extract.h"
#include "libvdbsynth/relief/growth/grown_relief.h"
#include "libvdbsynth/relief/growth/relief_match.h"
#include "libvdbsynth/relief/relief_layer.h"
#include "libvdbsynth/relief/transfer/relief_transfer.h"
#include "tests/quality/relief_answers.h"
#include "tests/support/own_base.h"

#include <cmath>
#include <memory>

namespace vdbsynth::quality {
namespace {

// A bumpy ball for what needs a scan.
LevelSet bumpy() {
    return asModel(fieldOf({101, 101, 101}, 3, [](const Vec3d& p) {
        const double r = length(p);
        if (r < 20) return -3.0;
        const Vec3d n = p * (1 / r);
        const double bumps = sine(10 * n.x) * sine(10 * n.y + 1) * sine(10 * n.z + 2);
        return (r - 40 - 2 * bumps) / 1.1;
    }));
}

void sumIsScan() {
    ReliefExtractOptions options;
    options.baseRadius = 6;
    options.strength = 1;
    const ReliefExtraction extraction = extractRelief(bumpy(), options);
    double most = 0, squares = 0, count = 0;
    const IndexBox box = boxOf(*extraction.surface.grid);
    const BrickField again = gatherNarrowBand(*extraction.surface.grid, box);
    for (const Vec3f& p : zeroLevel(again, again.box(), Facing::Outward).points) {
        const Vec3f place = p + cast<float>(at(box.min - extraction.corner));
        const double d = std::abs(double(sampleTrilinear(extraction.fields.scan, place)));
        most = std::max(most, d), squares += d * d, count += 1;
    }
    say("sum_rms", std::sqrt(squares / count));
    say("sum_largest_error", most);
}

// Every place of the base takes its own relief.
void identityOnOwnBase() {
    ReliefExtractOptions extract;
    extract.baseRadius = 6;
    const auto base = std::make_shared<const BaseSurface>(extractRelief(bumpy(), extract).fields);
    ReliefSampleOptions whole;
    whole.rough = 0;
    const std::vector<ReliefSample> samples{reliefSample(base, nullptr, whole)};
    ReliefTarget target = test::ownBase(samples.front());
    target.distance = widenBand({target.distance, target.distance.box(), target.reach}, 8);
    target.reach = 8;
    const BrickField made = reliefOnTarget(target, samples, test::identityMap(target, samples.front()));
    say("own_base_identity_rms", test::surfaceError(made, base->scan).rms);
}

// Through the whole library, which finds places by matching: a target that is the scan's own base.
void ownBase() {
    ReliefOptions options = along("axis:x");
    options.exemplarDirection = options.direction;
    options.baseRadius = 6;
    options.wholeSample = true;
    const LevelSet scan = bumpy();
    ReliefExtractOptions extract;
    extract.baseRadius = 6;
    const ReliefExtraction extraction = extractRelief(scan, extract);
    LevelSet base;
    base.grid = extraction.base.grid->deepCopy();
    base.domain = solidBox(*base.grid, "base");
    stampLevelSet(base);
    const ReliefResult made = transferRelief({{&scan, {}, 0, 0}}, base, nullptr, options);
    const Heights before = sampleHeights({&scan, {}, 0, 0}, options), after = madeHeights(made.model, base);
    say("own_base_sq_error", std::abs(after.statistics.sq / before.statistics.sq - 1));
    const IndexBox box = boxOf(*made.model.grid);
    const BrickField field = gatherNarrowBand(*made.model.grid, box);
    double squares = 0, count = 0;
    for (const Vec3f& p : zeroLevel(field, field.box(), Facing::Outward).points) {
        const Vec3f place = p + cast<float>(at(box.min - extraction.corner));
        const double d = double(sampleTrilinear(extraction.fields.scan, place));
        squares += d * d, count += 1;
    }
    say("own_base_matched_rms", std::sqrt(squares / count));
}

// The relief over a base as sites, +x along the tangents.
ReliefSites sitesOver(const BaseSurface& base) {
    ReliefSites relief;
    std::vector<Vec3f> normals;
    const Mesh mesh = zeroLevel(base.distance, base.distance.box(), Facing::Outward);
    for (const Vec3f& p : mesh.points) {
        normals.push_back(normalized(sampleGradient(base.distance, p)));
        const ReliefPoint over = reliefAt(base, p, normals.back());
        relief.displacement.push_back(over.folds ? over.vector : normals.back() * over.height);
        relief.tangent.push_back(tangentNear(normals.back(), {1, 0, 0}));
    }
    relief.sites = sitesOfPoints(mesh.points, normals, 8);
    return relief;
}

// The mean SSD of the relief over a base, with the best place of the sample for each of some sites.
double mismatchOf(const BaseSurface& made, const BaseSurface& sample, double radius) {
    constexpr std::size_t kOneOf = 50;  // sites: the search is exhaustive
    const ReliefSites surface = sitesOver(made);
    const ReliefDistance distance(sample.scan, {0, 0, 0}, 1, sample.reach);
    const ReliefNeighbourhoods all =
        reliefNeighbourhoods(surface.sites, radius, GrownReliefOptions{}.weightFalloff);
    ReliefNeighbourhoods some;
    for (std::size_t t = 0; t < surface.sites.size(); ++t) {
        some.begin.push_back(some.member.size());
        if (t % kOneOf != 0) continue;
        for (std::size_t k = all.begin[t]; k < all.begin[t + 1]; ++k) {
            some.member.push_back(all.member[k]);
            some.weight.push_back(all.weight[k]);
        }
    }
    some.begin.push_back(some.member.size());
    return bestMismatch(surface, sitesOver(sample), distance, some).mean;
}

}  // namespace

void printBallAnswers() {
    sumIsScan();
    identityOnOwnBase();
    ownBase();
}

// A ball of bumps on a plain one, default and exhaustive.
void printMismatch() {
    openvdb::initialize();
    const LevelSet scan = bumpy();
    const LevelSet target = asModel(fieldOf({73, 73, 73}, 3, [](const Vec3d& p) { return length(p) - 30; }));
    ReliefExtractOptions extract;
    extract.baseRadius = 6;
    const BaseSurface sample = extractRelief(scan, extract).fields;
    for (const ReliefMethod method : {ReliefMethod::Default, ReliefMethod::Paper}) {
        ReliefOptions options = along("axis:x");
        options.exemplarDirection = options.direction;
        options.baseRadius = 6;
        options.wholeSample = true;
        options.method = method;
        const ReliefResult made = transferRelief({{&scan, {}, 0, 0}}, target, nullptr, options);
        const Heights before = sampleHeights({&scan, {}, 0, 0}, options),
                      after = madeHeights(made.model, target);
        std::printf("%s %g %g", method == ReliefMethod::Paper ? "paper" : "default",
                    after.statistics.sq / before.statistics.sq,
                    wasserstein(before, after) / before.statistics.sq);
        for (const double radius : {4.0, 8.0})
            std::printf(" %g", mismatchOf(madeSurface(made.model, target), sample, radius));
        std::printf("\n");
    }
}

}  // namespace vdbsynth::quality
