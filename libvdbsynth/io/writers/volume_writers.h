#pragma once
#include "libvdbsynth/io/volume_file.h"

#include <cstdint>
#include <string>

namespace vdbsynth {

// Every format that is written holds the samples as they come, little-endian, between two runs of bytes.
struct VolumeFrame {
    std::string head, tail;
};

VolumeFrame npyFrame(const VolumeHead& head);
VolumeFrame tiffFrame(const VolumeHead& head);
VolumeFrame vtiFrame(const VolumeHead& head);
VolumeFrame niftiFrame(const VolumeHead& head);

// The code of a unit of length in NIfTI's xyzt_units; 0: it has none.
int niftiUnit(const std::string& unit);

// [cells] that NIfTI's floats move the farthest sample.
double niftiError(const VolumeHead& head);

// True if columns, rows and slices run along x, y and z, to 1e-9.
bool runsAlongWorld(const VolumeHead& head);

// [bytes] of all samples.
std::uint64_t sampleBytes(const VolumeHead& head);

// Appends a number of `bytes` bytes, the lowest first.
void appendLittle(std::string& text, std::uint64_t value, int bytes);

}  // namespace vdbsynth
