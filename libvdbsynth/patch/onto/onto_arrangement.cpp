#include "libvdbsynth/patch/onto/onto_arrangement.h"

#include "libvdbsynth/coordinates/site_chart.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

Vec2f reversed(const Vec2f& turn) {
    return {turn.x, -turn.y};
}

// The four columns around a place, and their weights.
struct Corners {
    const float* column[4];
    float weight[4];

    Corners(const PatchField& exemplar, const PlanePlace& place) {
        const PatchLattice& l = exemplar.lattice;
        const double x = place.x / l.step - 0.5, y = place.y / l.step - 0.5;
        const int i = int(std::floor(x)), j = int(std::floor(y));
        const float fx = float(x - i), fy = float(y - j);
        for (int c = 0; c < 4; ++c) {
            const int a = c >> 1, b = c & 1;
            column[c] = exemplar.column(std::clamp(i + a, 0, l.nx - 1), std::clamp(j + b, 0, l.ny - 1));
            weight[c] = (a ? fx : 1 - fx) * (b ? fy : 1 - fy);
        }
    }
};

}  // namespace

PlanePlace OntoPatch::inExemplar(const Vec2f& at) const {
    const Vec2f turned = rotated(at, turn);
    return {from.x + double(turned.x), from.y + double(turned.y)};
}

Vec2f OntoPatch::onDisk(const PlanePlace& place) const {
    return rotated(Vec2f{float(place.x - from.x), float(place.y - from.y)}, reversed(turn));
}

Vec2f turnBetween(const SurfaceDisk& from, std::ptrdiff_t a, const SurfaceDisk& to, std::ptrdiff_t b) {
    return rotated(from.turn[std::size_t(a)], reversed(to.turn[std::size_t(b)]));
}

void readBetween(const PatchField& exemplar, const PlanePlace& place, float* values) {
    const Corners corners(exemplar, place);
    for (std::size_t n = 0; n < exemplar.columnLength(); ++n)
        values[n] = corners.weight[0] * corners.column[0][n] + corners.weight[1] * corners.column[1][n] +
                    corners.weight[2] * corners.column[2][n] + corners.weight[3] * corners.column[3][n];
}

void readDistances(const PatchField& exemplar, const PlanePlace& place, float* values) {
    const Corners corners(exemplar, place);
    for (int k = 0; k < exemplar.lattice.nz; ++k) {
        const int n = k * kFieldValues;
        values[k] = corners.weight[0] * corners.column[0][n] + corners.weight[1] * corners.column[1][n] +
                    corners.weight[2] * corners.column[2][n] + corners.weight[3] * corners.column[3][n];
    }
}

float readDistance(const PatchField& exemplar, const PlanePlace& place, int k) {
    const Corners corners(exemplar, place);
    float sum = 0;
    for (int c = 0; c < 4; ++c) sum += corners.weight[c] * corners.column[c][k * kFieldValues];
    return sum;
}

void readOnto(const PatchField& exemplar, const OntoArrangement& arrangement, const SurfaceDisk& disk,
              std::ptrdiff_t member, const Vec2f& at, float* values) {
    const std::uint32_t site = disk.site[std::size_t(member)];
    const std::int32_t* labels = arrangement.column(site);
    std::vector<float> read(exemplar.columnLength());
    for (int k = 0; k < arrangement.nz;) {
        const std::int32_t label = labels[k];
        const OntoPatch& patch = arrangement.patches[std::size_t(label)];
        const std::ptrdiff_t other = patch.disk.find(site);
        const Vec2f turn = turnBetween(disk, member, patch.disk, other);
        readBetween(exemplar,
                    patch.inExemplar(patch.disk.at[std::size_t(other)] +
                                     rotated(at - disk.at[std::size_t(member)], turn)),
                    read.data());
        const Vec2f back = reversed(rotated(turn, patch.turn));
        for (; k < arrangement.nz && labels[k] == label; ++k) {
            const float* node = read.data() + k * kFieldValues;
            const Vec2f gradient = rotated({node[1], node[2]}, back);
            float* to = values + k * kFieldValues;
            to[0] = node[0];
            to[1] = gradient.x;
            to[2] = gradient.y;
            to[3] = node[3];
        }
    }
}

}  // namespace vdbsynth
