// Charts as an atlas.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/grid/field_sampling.h"
#include "libvdbsynth/relief/transfer/relief_sample_steps.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <utility>

namespace vdbsynth {
namespace {

constexpr int kGap = 4;         // texels between charts
constexpr int kContinued = 64;  // rings of texels beyond charts that continue them; the rest is 0

struct Packed {
    Vec2f low;  // [voxels] of the chart
    int width, height;
    int x = 0, y = 0;  // [texels] in the atlas
};

Packed boxOf(const ReliefChart& chart) {
    Vec2f low = chart.at[0], high = chart.at[0];
    for (const Vec2f& p : chart.at) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    return {low, int(std::ceil(high.x - low.x)) + 1, int(std::ceil(high.y - low.y)) + 1};
}

// Rows of charts, the highest first, about as wide as high. @return the atlas's width and height
std::pair<int, int> packRows(std::vector<Packed>& packed) {
    std::vector<std::size_t> order(packed.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return packed[a].height > packed[b].height; });
    double area = 0;
    int widest = 0;
    for (const Packed& p : packed) {
        area += double(p.width + kGap) * double(p.height + kGap);
        widest = std::max(widest, p.width);
    }
    const int width = std::max(widest, int(std::ceil(std::sqrt(area)))) + 2 * kGap;
    int x = kGap, y = kGap, row = 0;
    for (std::size_t i : order) {
        Packed& p = packed[i];
        if (x + p.width + kGap > width) {
            x = kGap;
            y += row + kGap;
            row = 0;
        }
        p.x = x;
        p.y = y;
        x += p.width + kGap;
        row = std::max(row, p.height);
    }
    return {width, y + row + kGap};
}

// A triangle of an atlas.
struct Flat {
    std::array<Vec2f, 3> corner;
    Triangle site;
};

// Calls place(x, y, weights) for the texels whose centres lie in a triangle.
template <typename Place>
void fillTriangle(const Flat& t, int width, int height, const Place& place) {
    const Vec2f a = t.corner[0], ab = t.corner[1] - a, ac = t.corner[2] - a;
    const float area = ab.x * ac.y - ab.y * ac.x;
    if (!(area > 1e-6f)) return;  // folded over, or without area
    const auto [lowX, highX] = std::minmax({t.corner[0].x, t.corner[1].x, t.corner[2].x});
    const auto [lowY, highY] = std::minmax({t.corner[0].y, t.corner[1].y, t.corner[2].y});
    for (int y = std::max(0, int(std::floor(lowY))); y <= std::min(height - 1, int(highY)); ++y)
        for (int x = std::max(0, int(std::floor(lowX))); x <= std::min(width - 1, int(highX)); ++x) {
            const Vec2f ap = Vec2f{float(x) + 0.5f, float(y) + 0.5f} - a;
            const float v = (ap.x * ac.y - ap.y * ac.x) / area, w = (ab.x * ap.y - ab.y * ap.x) / area;
            if (v >= -1e-4f && w >= -1e-4f && v + w <= 1 + 1e-4f)
                place(x, y, std::array<float, 3>{1 - v - w, v, w});
        }
}

// The faces whose corners are all in a chart.
std::vector<Flat> facesOf(const ReliefChart& chart, const Packed& packed,
                          const std::vector<Triangle>& triangles,
                          const std::vector<std::vector<std::uint32_t>>& facesAt, std::vector<Vec2f>& at,
                          std::vector<char>& in) {
    const Vec2f shift{float(packed.x) + 0.5f - packed.low.x, float(packed.y) + 0.5f - packed.low.y};
    for (std::size_t k = 0; k < chart.site.size(); ++k) {
        at[chart.site[k]] = chart.at[k] + shift;
        in[chart.site[k]] = 1;
    }
    std::vector<Flat> faces;
    for (std::uint32_t site : chart.site)
        for (std::uint32_t f : facesAt[site]) {
            const Triangle& t = triangles[f];
            if (in[t[0]] && in[t[1]] && in[t[2]]) faces.push_back({{at[t[0]], at[t[1]], at[t[2]]}, t});
        }
    for (std::uint32_t site : chart.site) in[site] = 0;
    return faces;
}

// Faces by their first corner.
std::vector<std::vector<std::uint32_t>> facesAtSites(const std::vector<Triangle>& triangles,
                                                     std::size_t sites) {
    std::vector<std::vector<std::uint32_t>> at(sites);
    for (std::uint32_t f = 0; f < triangles.size(); ++f) at[triangles[f][0]].push_back(f);
    return at;
}

// Onto the base, by two Newton steps along its gradient.
void moveOntoBase(const BrickField& distance, Vec3f& place, Vec3f& normal) {
    for (int step = 0; step < 2; ++step) {
        const Vec3f gradient = sampleGradient(distance, place);
        const float squared = dot(gradient, gradient);
        if (!(squared > 1e-4f)) return;
        place = place - gradient * std::clamp(sampleTrilinear(distance, place) / squared, -0.5f, 0.5f);
    }
    const Vec3f gradient = normalized(sampleGradient(distance, place));
    if (dot(gradient, gradient) > 0) normal = gradient;
}

// Without the texels at the charts' borders; with them where nothing else would be left.
std::vector<char> withoutBorders(const std::vector<char>& known, int width, int height) {
    std::vector<char> valid = known, next;
    for (int ring = 0; ring < kChartBorder; ++ring) {
        next = valid;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const auto at = [&](int i, int j) {
                    return i >= 0 && j >= 0 && i < width && j < height &&
                           valid[std::size_t(j) * std::size_t(width) + std::size_t(i)];
                };
                if (!(at(x - 1, y) && at(x + 1, y) && at(x, y - 1) && at(x, y + 1)))
                    next[std::size_t(y) * std::size_t(width) + std::size_t(x)] = 0;
            }
        valid = next;
    }
    return std::find(valid.begin(), valid.end(), char(1)) != valid.end() ? valid : known;
}

}  // namespace

void packCharts(const std::vector<ReliefChart>& charts, const std::vector<Triangle>& triangles,
                const SurfaceSites& sites, std::size_t largest, ReliefSample& sample, const RunContext& ctx) {
    std::vector<Packed> packed;
    for (const ReliefChart& chart : charts) packed.push_back(boxOf(chart));
    const std::pair<int, int> sides = packRows(packed);
    const int width = sides.first, height = sides.second;
    if (std::size_t(width) * std::size_t(height) > largest)
        throw Error(ErrorCode::Memory, "the flattened sample would have " + std::to_string(width) + " x " +
                                           std::to_string(height) + " texels; use larger voxels for it");
    sample.image.width = width;
    sample.image.height = height;
    sample.known.assign(sample.image.texels(), 0);
    sample.place.assign(sample.image.texels(), {});
    sample.normal.assign(sample.image.texels(), {});
    const std::vector<std::vector<std::uint32_t>> facesAt = facesAtSites(triangles, sites.size());
    std::vector<Vec2f> at(sites.size());
    std::vector<char> in(sites.size(), 0), shown(sites.size(), 0);
    for (std::size_t c = 0; c < charts.size(); ++c) {
        for (const Flat& face : facesOf(charts[c], packed[c], triangles, facesAt, at, in)) {
            for (std::uint32_t site : face.site) shown[site] = 1;
            fillTriangle(face, width, height, [&](int x, int y, const std::array<float, 3>& weight) {
                const std::size_t i = std::size_t(y) * std::size_t(width) + std::size_t(x);
                Vec3f place, normal;
                for (std::size_t k = 0; k < 3; ++k) {
                    place = place + sites.point[face.site[k]] * weight[k];
                    normal = normal + sites.normal[face.site[k]] * weight[k];
                }
                sample.place[i] = place;
                sample.normal[i] = normalized(normal);
                sample.known[i] = 1;
            });
        }
        throwIfCancelled(ctx);
    }
    sample.image.valid = withoutBorders(sample.known, width, height);
    sample.covered = double(std::count(shown.begin(), shown.end(), char(1))) / double(sites.size());
    parallelFor(ctx, sample.place.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (sample.known[i]) moveOntoBase(sample.surface->distance, sample.place[i], sample.normal[i]);
    });
}

void continueBeyondCharts(ReliefSample& sample, const RunContext& ctx) {
    SampleImage& image = sample.image;
    const std::size_t channels = std::size_t(image.channels);
    std::vector<char> known = sample.known, next = known;
    for (int ring = 0; ring < kContinued; ++ring) {
        std::atomic<bool> more{false};
        parallelFor(ctx, std::size_t(image.height), 16, [&](std::size_t begin, std::size_t end) {
            for (int y = int(begin); y < int(end); ++y)
                for (int x = 0; x < image.width; ++x) {
                    const std::size_t i = std::size_t(y) * std::size_t(image.width) + std::size_t(x);
                    if (known[i]) continue;
                    float* out = image.values.data() + i * channels;
                    int count = 0;
                    for (int dy = -1; dy <= 1; ++dy)
                        for (int dx = -1; dx <= 1; ++dx) {
                            const int nx = x + dx, ny = y + dy;
                            if (nx < 0 || ny < 0 || nx >= image.width || ny >= image.height) continue;
                            const std::size_t n =
                                std::size_t(ny) * std::size_t(image.width) + std::size_t(nx);
                            if (!known[n]) continue;
                            for (std::size_t c = 0; c < channels; ++c)
                                out[c] += image.values[n * channels + c];
                            ++count;
                        }
                    if (count == 0) continue;
                    for (std::size_t c = 0; c < channels; ++c) out[c] /= float(count);
                    next[i] = 1;
                    more = true;
                }
        });
        if (!more) return;
        known = next;
    }
}

Placed3 placeAt(const ReliefSample& sample, const Vec2f& at) {
    const SampleImage& image = sample.image;
    const float x = at.x - 0.5f, y = at.y - 0.5f;
    const int left = int(std::floor(x)), low = int(std::floor(y));
    const float fx = x - float(left), fy = y - float(low);
    Placed3 sum;
    float whole = 0;
    std::size_t nearest = 0;
    for (int k = 0; k < 4; ++k) {
        const int i = std::clamp(left + (k & 1), 0, image.width - 1),
                  j = std::clamp(low + (k >> 1), 0, image.height - 1);
        const std::size_t n = std::size_t(j) * std::size_t(image.width) + std::size_t(i);
        const float weight = ((k & 1) ? fx : 1 - fx) * ((k >> 1) ? fy : 1 - fy);
        if (!sample.known[n] || !(weight > 0)) continue;
        sum.place = sum.place + sample.place[n] * weight;
        sum.normal = sum.normal + sample.normal[n] * weight;
        whole += weight;
        nearest = n;
    }
    if (!(whole > 0)) return {sample.place[nearest], sample.normal[nearest]};
    return {sum.place * (1 / whole), normalized(sum.normal)};
}

}  // namespace vdbsynth
