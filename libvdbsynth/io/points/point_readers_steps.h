#pragma once
// Parts of the reader of .pcd.
#include "libvdbsynth/base/run_context.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vdbsynth {

struct PcdField {
    std::string name;
    std::int64_t size = 4, count = 1, offset = 0;
    char type = 'F';
};

struct PcdHeader {
    std::vector<PcdField> fields;
    std::int64_t points = -1, rowBytes = 0;
    std::int64_t grid = -1;  // width times height, -1 if it has none
    std::string data;        // in lower case
    std::size_t bytes = 0;
};

// Versions 0.5 to 0.7, keys and types in any case. What it lacks or contradicts is a message.
// @throw Error BadData
PcdHeader readPcdHeader(const std::string& path, const std::string& content, const RunContext& ctx);

// LZF to exactly `size` bytes. @throw Error BadData
std::string unpackLzf(const std::string& path, std::string_view packed, std::size_t size);

}  // namespace vdbsynth
