#pragma once
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

namespace vdbsynth::test {

/// A folder that goes with the object.
class TemporaryFolder {
public:
    TemporaryFolder() {
        static int made = 0;
        mPath = std::filesystem::temp_directory_path() /
                ("vdbsynth_test_" + std::to_string(::getpid()) + "_" + std::to_string(made++));
        std::filesystem::create_directories(mPath);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(mPath, ignored);
    }
    std::string path(const std::string& name) const { return (mPath / name).string(); }
    std::string write(const std::string& name, const std::string& content) const {
        std::ofstream(path(name), std::ios::binary) << content;
        return path(name);
    }
    std::size_t fileCount() const {
        return std::size_t(
            std::distance(std::filesystem::directory_iterator(mPath), std::filesystem::directory_iterator()));
    }

private:
    std::filesystem::path mPath;
};

inline std::string contentOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace vdbsynth::test
