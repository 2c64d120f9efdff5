#include "libvdbsynth/base/error.h"

namespace vdbsynth {

int exitCode(ErrorCode code) noexcept {
    switch (code) {
        case ErrorCode::InvalidOption:
            return 2;
        case ErrorCode::Io:
        case ErrorCode::BadData:
            return 3;
        case ErrorCode::Cancelled:
            return 130;
        case ErrorCode::ShapeMismatch:
        case ErrorCode::EmptyInput:
        case ErrorCode::Unusable:
        case ErrorCode::Memory:
        case ErrorCode::Solver:
            return 1;
    }
    return 1;
}

void requireOption(bool valid, const std::string& field, const std::string& value, const std::string& range) {
    if (!valid) throw Error(ErrorCode::InvalidOption, "`" + field + "` " + value + ": must be " + range);
}

}  // namespace vdbsynth
