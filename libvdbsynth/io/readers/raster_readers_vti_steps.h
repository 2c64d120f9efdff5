#pragma once
#include "libvdbsynth/base/run_context.h"

#include <cstddef>
#include <string>
#include <vector>

namespace vdbsynth {

// Of the data of a VTK XML file, from its root element.
struct VtkEncoding {
    bool swap = false, compressed = false, wideHeader = false;
    std::string appended;  // raw or still base64
    bool appendedBase64 = false;
};

// A data array: what its element says, and its text if it stands inline.
struct VtkArray {
    std::string name, type, format, text;
    int components = 1;
    std::size_t offset = 0;  // into the appended data
    bool cells = false;
};

// Raw appended data is not XML: it is cut out before the rest is parsed. @return the rest
std::string cutAppended(const std::string& content, VtkEncoding& encoding);

// @throw Error BadData (a type that is not read)
std::size_t bytesOfVtkType(const std::string& path, const VtkArray& array);
// The value of white in the array's type, 0 if pictures do not use the type.
double whiteOfVtkType(const std::string& path, const VtkArray& array);

// Reads an array of `count` samples; of vectors the lengths. Text may hold "nan".
// @throw Error BadData (truncated, corrupt), Memory
std::vector<float> readVtkArray(const std::string& path, const VtkArray& array, const VtkEncoding& encoding,
                                std::size_t count, const RunContext& ctx);

}  // namespace vdbsynth
