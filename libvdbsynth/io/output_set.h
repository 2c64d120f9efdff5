#pragma once
#include <functional>
#include <string>
#include <vector>

namespace vdbsynth {

/// The outputs of one run. Each is written to `.NAME.PID.tmp` in its own folder (`.NAME.PID-2.tmp` if another
/// set of this process writes the same file); `commit` renames them once all are complete and on disk, so
/// that a failed, killed or full-disk run never leaves a partial file or damages an old one. Stale temporary
/// files of dead runs with the same name are removed when a path is added.
class OutputSet {
public:
    /// @param onTemporary  called with each temporary path before it is created (the supervisor removes them
    /// if this process dies)
    explicit OutputSet(std::function<void(const std::string&)> onTemporary = {});
    /// Removes what was not committed.
    ~OutputSet();
    OutputSet(const OutputSet&) = delete;
    OutputSet& operator=(const OutputSet&) = delete;

    /// Registers an output. @return the path to write instead
    /// @throw Error Io (no such folder, not the one reserved in, no permission, not a regular file),
    /// InvalidOption (named twice, also by another path)
    std::string add(const std::string& path);
    /// Creates the temporary file of an output that `add` will request later, so that an unwritable path is
    /// reported before the work starts.
    /// @throw Error as add
    void reserve(const std::string& path);
    /// A message with the outputs' names in place of their temporary files' names.
    std::string withoutTemporaries(std::string text) const;
    /// Syncs all temporary files to disk, then renames them in the order they were added. A path that was
    /// reserved but never requested with `add` keeps its old file.
    /// @throw Error Io; nothing was renamed unless a rename itself failed
    void commit();

private:
    struct Entry {
        std::string path, target, unique, temporary;
        bool taken;
    };
    void open(const std::string& path);
    std::vector<Entry> mEntries;
    std::function<void(const std::string&)> mOnTemporary;
};

}  // namespace vdbsynth
