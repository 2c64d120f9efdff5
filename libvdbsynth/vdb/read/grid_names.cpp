#include "libvdbsynth/vdb/read/grid_names.h"

#include "libvdbsynth/base/printable_text.h"
#include "libvdbsynth/vdb/grid_kinds.h"

#include <map>

namespace vdbsynth {

std::vector<std::string> uniqueNamesOf(const std::vector<GridPtr>& grids) {
    std::map<std::string, std::size_t> counts, next;
    for (const GridPtr& grid : grids) ++counts[grid->getName()];
    std::vector<std::string> names;
    for (const GridPtr& grid : grids) {
        const std::string name = grid->getName();
        names.push_back(counts[name] == 1 ? name : name + "[" + std::to_string(next[name]++) + "]");
    }
    return names;
}

GridPtr gridNamed(const std::vector<GridPtr>& grids, const std::string& name, std::size_t* several) {
    GridPtr found;
    std::size_t count = 0;
    for (const GridPtr& grid : grids)
        if (grid->getName() == name) {
            if (!found) found = grid;
            ++count;
        }
    if (!found) {
        const std::vector<std::string> names = uniqueNamesOf(grids);
        for (std::size_t i = 0; i < grids.size() && !found; ++i)
            if (names[i] == name) found = grids[i];
        count = found ? 1 : 0;
        // A single grid is its own first one.
        if (!found && name.size() > 3 && name.compare(name.size() - 3, 3, "[0]") == 0)
            found = gridNamed(grids, name.substr(0, name.size() - 3), &count);
    }
    if (several) *several = count;
    return found;
}

std::string listOf(const std::vector<GridPtr>& grids) {
    constexpr std::size_t kMost = 30;
    const std::vector<std::string> names = uniqueNamesOf(grids);
    std::string list;
    for (std::size_t i = 0; i < grids.size() && i < kMost; ++i)
        list += (i > 0 ? ", " : "") + printableText(names[i], 80) + " (" + grids[i]->valueType() + ")";
    if (grids.size() > kMost) list += ", and " + std::to_string(grids.size() - kMost) + " more";
    return list.empty() ? "no grids" : list;
}

}  // namespace vdbsynth
