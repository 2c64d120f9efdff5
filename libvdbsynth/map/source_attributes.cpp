#include "libvdbsynth/map/source_attributes.h"

#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/parallel.h"
#include "libvdbsynth/map/exemplar_variant.h"
#include "libvdbsynth/map/source_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr double kExactFloat = 1 << 24;

// Appends the vector that `of` gives for every element's strongest source, if any differs from `usual`.
template <typename Of>
void append(Attributes& attributes, const ElementSources& sources, const char* name, std::size_t width,
            float usual, bool always, const Of& of) {
    Attribute attribute{name, width, std::vector<float>(sources.size() * width, usual)};
    bool any = always;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const Source* source = sources.strongest(i);
        if (!source) continue;
        const Vec3d value = of(*source);
        for (std::size_t axis = 0; axis < width; ++axis) {
            const float written = float(value[int(axis)]);
            attribute.values[i * width + axis] = written;
            any = any || written != usual;
        }
    }
    if (any) attributes.push_back(std::move(attribute));
}

Vec3d voxelOf(const Source& source) {
    const Index3 voxel = nearestVoxel(source);
    return {double(voxel.x), double(voxel.y), double(voxel.z)};
}

// The largest coordinate, NaN if any is NaN.
double farthest(const Vec3d& place) {
    if (!std::isfinite(dot(place, place))) return NAN;
    return std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)});
}

const Attribute* columnsOf(const Attributes& attributes, const std::string& name, std::size_t width,
                           std::size_t rows) {
    const Attribute* attribute = findAttribute(attributes, name);
    if (attribute && (attribute->width != width || attribute->values.size() != rows * width))
        throw Error(ErrorCode::BadData, "attribute \"" + name + "\" is not " + std::to_string(width) +
                                            " numbers for each of " + std::to_string(rows) + " elements");
    return attribute;
}

Vec3d rowOf(const Attribute* attribute, std::size_t i, double missing) {
    Vec3d row{missing, missing, missing};
    if (attribute)
        for (std::size_t axis = 0; axis < attribute->width; ++axis)
            row[int(axis)] = double(attribute->values[i * attribute->width + axis]);
    return row;
}

}  // namespace

Attributes sourceAttributes(const ElementSources& sources) {
    requireOption(sources.kind() != ElementKind::Voxel, "kind", "voxel",
                  "point, vertex or corner; a map of voxels is written as grids");
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const Source* source = sources.strongest(i);
        if (source && farthest(voxelOf(*source)) > kExactFloat)
            throw Error(ErrorCode::Unusable,
                        "element " + std::to_string(i) +
                            " of the source map was copied from beyond 2^24 voxels, which attributes cannot "
                            "hold exactly; move the exemplar nearer to the origin");
    }
    Attributes all;
    append(all, sources, "source", 3, 0, true, voxelOf);
    append(all, sources, "exemplar", 1, -1, true, [](const Source& s) {
        return Vec3d{double(s.exemplar), 0, 0};
    });
    append(all, sources, "source_offset", 3, 0, false,
           [](const Source& s) { return s.position - voxelOf(s); });
    append(all, sources, "source_rotation", 3, 0, false,
           [](const Source& s) { return cast<double>(s.rotation); });
    append(all, sources, "source_scale", 1, 1, false, [](const Source& s) {
        return Vec3d{double(s.scale), 0, 0};
    });
    append(all, sources, "source_weight", 1, 1, false, [](const Source& s) {
        return Vec3d{double(s.weight), 0, 0};
    });
    return all;
}

ElementSources sourcesFromAttributes(const Attributes& attributes, ElementKind kind) {
    const Attribute* exemplar = findAttribute(attributes, "exemplar");
    if (!exemplar || !findAttribute(attributes, "source"))
        throw Error(ErrorCode::BadData, "no source map: attributes \"source\" and \"exemplar\" are missing");
    const std::size_t rows = exemplar->values.size();
    columnsOf(attributes, "exemplar", 1, rows);
    const Attribute *voxel = columnsOf(attributes, "source", 3, rows),
                    *offset = columnsOf(attributes, "source_offset", 3, rows),
                    *rotation = columnsOf(attributes, "source_rotation", 3, rows),
                    *scale = columnsOf(attributes, "source_scale", 1, rows),
                    *weight = columnsOf(attributes, "source_weight", 1, rows);
    ElementSources sources(kind);
    for (std::size_t i = 0; i < rows; ++i) {
        const double number = rowOf(exemplar, i, -1).x;
        if (number == -1) {
            sources.add(std::vector<Source>{});
            continue;
        }
        Source source;
        const Vec3d place = rowOf(voxel, i, 0), by = rowOf(offset, i, 0),
                    rotationVector = rowOf(rotation, i, 0);
        source.scale = float(rowOf(scale, i, 1).x);
        source.weight = float(rowOf(weight, i, 1).x);
        if (!(number >= 0 && number < kExactFloat && number == std::floor(number)) ||
            !(farthest(place) <= kExactFloat) || !(length(by) <= 2) || !(length(rotationVector) <= 100) ||
            !(source.scale > 0 && source.scale < 1e6f) || !(source.weight > 0 && source.weight < 1e6f))
            throw Error(ErrorCode::BadData,
                        "element " + std::to_string(i) + " of the source map has invalid numbers");
        source.exemplar = std::int32_t(number);
        source.position = place + by;
        source.rotation = cast<float>(rotationVector);
        sources.add({source});
    }
    return sources;
}

Attribute transferredAttribute(const ElementSources& sources, const AttributeReader& reader, bool blended,
                               const RunContext& ctx) {
    requireOption(reader.width >= 1 && reader.width <= 3 && (!reader.direction || reader.width == 3), "width",
                  std::to_string(reader.width), "1 to 3, and 3 for a direction");
    Attribute attribute{reader.name, reader.width, std::vector<float>(sources.size() * reader.width, 0.f)};
    parallelFor(ctx, sources.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Vec3d sum;
            double total = 0;
            for (const Source& source : sources[i]) {
                std::array<float, 3> read{};
                if (!reader.read(source.exemplar, source.position, read.data())) continue;
                Vec3d value{double(read[0]), double(read[1]), double(read[2])};
                if (reader.direction)
                    value = transformed(rotationMatrix(cast<double>(source.rotation)), value);
                const double weight = blended ? double(source.weight) : 1;
                sum = sum + value * weight;
                total += weight;
                if (!blended) break;
            }
            for (std::size_t axis = 0; axis < reader.width && total > 0; ++axis)
                attribute.values[i * reader.width + axis] = float(sum[int(axis)] / total);
        }
    });
    return attribute;
}

}  // namespace vdbsynth
