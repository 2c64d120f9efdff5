#pragma once
#include <functional>
#include <string>
#include <vector>

namespace vdbsynth {

/// The outputs of one run. Each is written to `.NAME.PID.tmp` in its own folder; `commit` renames them
/// once all are complete and on disk, so that a failed, killed or full-disk run never leaves a half file
/// and never harms an old one. Stale temporaries of dead runs with the same name go when a path is added.
class OutputSet {
public:
    /// @param onTemporary  told each temporary's path before it is made (the supervisor removes them
    ///                     if this process dies)
    explicit OutputSet(std::function<void(const std::string&)> onTemporary = {});
    /// Removes what was not committed.
    ~OutputSet();
    OutputSet(const OutputSet&) = delete;
    OutputSet& operator=(const OutputSet&) = delete;

    /// Registers an output. @return the path to write instead
    /// @throw Error Io (no such folder, no permission, a directory), InvalidOption (named twice)
    std::string add(const std::string& path);
    /// Syncs all temporaries to disk, then renames them in the order they were added.
    /// @throw Error Io; nothing was renamed unless a rename itself failed
    void commit();

private:
    struct Entry {
        std::string path, temporary;
    };
    std::vector<Entry> mEntries;
    std::function<void(const std::string&)> mOnTemporary;
};

}  // namespace vdbsynth
