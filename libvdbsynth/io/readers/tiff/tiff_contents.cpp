#include "libvdbsynth/io/readers/tiff/tiff_contents.h"

#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace vdbsynth {
namespace {

using Group = std::vector<std::size_t>;  // pages of one size and kind

std::string sizeText(const TiffPage& page) {
    return std::to_string(page.width) + " x " + std::to_string(page.height) + ", " +
           std::to_string(page.bits) + " bits";
}

std::string pageName(std::size_t page) {
    return "page" + std::to_string(page + 1);
}

// Pages of one size and kind together, without those that other pages have as copies or opacity.
std::vector<Group> groupsOf(const std::string& path, const std::vector<TiffPage>& pages,
                            TiffContents& contents, const RunContext& ctx) {
    constexpr std::size_t kMostGroups = 256;
    std::vector<Group> groups;
    std::size_t reduced = 0, beyond = 0;
    const bool allReduced =
        std::all_of(pages.begin(), pages.end(), [](const TiffPage& p) { return p.reduced || p.mask; });
    for (std::size_t i = 0; i < pages.size(); ++i) {
        const bool copy = pages[i].reduced || pages[i].mask;
        if (copy && !allReduced) {
            if (pages[i].mask && !pages[i].reduced) contents.masks.push_back(i);
            reduced += pages[i].reduced ? 1 : 0;
            continue;
        }
        const auto group = std::find_if(groups.begin(), groups.end(),
                                        [&](const Group& g) { return pages[g.front()].matches(pages[i]); });
        if (group != groups.end())
            group->push_back(i);
        else if (groups.size() < kMostGroups)
            groups.push_back({i});
        else
            ++beyond;
    }
    if (reduced > 0)
        message(ctx, MessageLevel::Note,
                path + ": its " + std::to_string(reduced) +
                    (reduced == 1 ? " reduced page (a preview) is" : " reduced pages (previews) are") +
                    " left out");
    if (beyond > 0)
        message(ctx, MessageLevel::Warning,
                path + ": " + std::to_string(beyond) + " pages of further sizes are left out");
    return groups;
}

// True if every group is a smaller copy of the first: one page each, shrinking at the same ratio of sides.
bool isPyramid(const std::vector<TiffPage>& pages, const std::vector<Group>& groups) {
    const TiffPage& full = pages[groups.front().front()];
    if (groups.front().size() > 1) return false;
    std::int64_t width = full.width;
    for (std::size_t i = 1; i < groups.size(); ++i) {
        const TiffPage& page = pages[groups[i].front()];
        const std::int64_t cross =
            std::abs(std::int64_t(page.width) * full.height - std::int64_t(page.height) * full.width);
        const bool smaller = page.width < width || (page.width == 1 && page.height == 1);
        if (groups[i].size() > 1 || !smaller || page.bits != full.bits || page.samples != full.samples ||
            cross > 2 * std::max<std::int64_t>(full.width, full.height))
            return false;
        width = page.width;
    }
    return true;
}

void sayOtherGroups(const std::string& path, const std::vector<TiffPage>& pages,
                    const std::vector<Group>& groups, const RunContext& ctx) {
    constexpr std::size_t kMostListed = 5;
    std::string others;
    for (std::size_t i = 1; i < std::min(groups.size(), kMostListed + 1); ++i)
        others += (i > 1 ? ", " : "") + pageName(groups[i].front()) + " (" +
                  sizeText(pages[groups[i].front()]) +
                  (groups[i].size() > 1 ? ", " + std::to_string(groups[i].size()) + " pages" : "") + ")";
    if (groups.size() > kMostListed + 1)
        others += " and " + std::to_string(groups.size() - kMostListed - 1) + " more";
    const Group& first = groups.front();
    const std::string read = pageName(first.front()) + " (" + sizeText(pages[first.front()]) +
                             (first.size() > 1 ? ", " + std::to_string(first.size()) + " pages" : "") + ")";
    if (isPyramid(pages, groups))
        message(ctx, MessageLevel::Note,
                path + ": " + read + " is read; its smaller copies (mip levels) are left out: " + others +
                    "; `grid` chooses one");
    else
        message(ctx, MessageLevel::Warning,
                path + ": its pages differ in size or kind: " + read + " is read, left out are " + others +
                    "; `grid` chooses one");
}

// The samples that make a grey or coloured picture.
TiffSamples pictureOf(const TiffPage& page, bool stack) {
    const bool grey = page.colour == TiffColour::BlackIsZero || page.colour == TiffColour::WhiteIsZero;
    if (!isStored(page, stack)) return {0, grey ? 1 : 3};
    return {0, page.colour == TiffColour::Rgb && dataSamples(page) >= 3 ? 3 : 1};
}

// A time series of single images: its frames become slices, as time and depth are often confused.
bool framesToSlices(StackDescription& description) {
    if (description.slices != 1 || description.frames < 2) return false;
    std::swap(description.slices, description.frames);
    for (char& axis : description.order) axis = axis == 'Z' ? 'T' : axis == 'T' ? 'Z' : axis;
    for (StackDescription::Block& block : description.blocks) std::swap(block.slice, block.frame);
    return true;
}

// The choices of a stack whose planes are known.
std::vector<TiffChoice> planeChoices(const StackDescription& d, const std::vector<std::size_t>& planes,
                                     const TiffPage& page) {
    const bool stack = planes.size() > 1;
    const TiffSamples picture = pictureOf(page, stack);
    const std::size_t slices = std::size_t(d.slices), frames = std::size_t(d.frames);
    const std::size_t pageChannels = planes.size() / (slices * frames);
    const std::size_t samples = isStored(page, stack) ? dataSamples(page) : 1;
    const bool perSample = samples > std::size_t(picture.channels) &&
                           productFits({std::int64_t(planes.size()), std::int64_t(samples)}, 1 << 16);
    std::vector<TiffChoice> choices;
    for (std::size_t t = 0; t < frames; ++t)
        for (std::size_t c = 0; c < pageChannels; ++c) {
            const auto begin = planes.begin() + std::ptrdiff_t((t * pageChannels + c) * slices);
            TiffChoice choice{"", {begin, begin + std::ptrdiff_t(slices)}, picture};
            const std::string frame = frames > 1 ? "frame" + std::to_string(t + 1) : "";
            const auto add = [&](const std::string& channel) {
                choice.name = channel + (channel.empty() || frame.empty() ? "" : "-") + frame;
                choices.push_back(choice);
            };
            if (!perSample) {
                add(pageChannels > 1 ? "channel" + std::to_string(c + 1) : "");
                continue;
            }
            if (picture.channels > 1) add(pageChannels > 1 ? "colour" + std::to_string(c + 1) : "colour");
            for (std::size_t s = 0; s < samples; ++s) {
                choice.samples = {s, 1};
                add("channel" + std::to_string(c * samples + s + 1));
            }
        }
    return choices;
}

// A stack of all pages, whatever the description says.
StackDescription plainStack(const StackDescription& description, std::size_t pages) {
    StackDescription plain = description;
    plain.channels = plain.frames = 1;
    plain.slices = std::int64_t(pages);
    return plain;
}

std::vector<TiffChoice> describedChoices(const std::string& path, TiffContents& contents, const Group& group,
                                         const TiffPage& page, std::size_t pages, const RunContext& ctx) {
    StackDescription& d = contents.description;
    // OME counts all pages of the file; the others those of one kind.
    const bool ome = d.kind == StackDescription::Kind::Ome;
    const bool framed = group.size() > 1 && framesToSlices(d);
    std::vector<std::size_t> planes = planePages(d, ome ? pages : group.size(), dataSamples(page));
    if (!ome)
        for (std::size_t& plane : planes) plane = group[plane];
    std::vector<char> alike(pages, 0);
    for (std::size_t member : group) alike[member] = 1;
    if (std::any_of(planes.begin(), planes.end(), [&](std::size_t plane) { return alike[plane] == 0; }))
        planes.clear();
    if (planes.empty()) {
        // Of a page's samples, tifffile's shape tells as of slices.
        const std::int64_t told = d.channels * d.slices * d.frames, pageCount = std::int64_t(group.size());
        const bool says =
            d.kind != StackDescription::Kind::None && told > 1 && told != pageCount * page.samples;
        if (says)
            message(ctx, MessageLevel::Warning,
                    path + ": its " + nameOf(d.kind) + " tells of " + std::to_string(d.channels) +
                        " channels, " + std::to_string(d.slices) + " slices and " + std::to_string(d.frames) +
                        " frames" + (d.severalFiles ? " in several files" : "") + ", which its " +
                        std::to_string(group.size()) + " pages are not; they are read as one stack");
        d = plainStack(d, group.size());
        return planeChoices(d, group, page);
    }
    if (framed)
        message(ctx, MessageLevel::Warning,
                path + ": holds " + std::to_string(d.slices) +
                    " frames of one slice each; the frames are read as slices");
    std::vector<TiffChoice> choices = planeChoices(d, planes, page);
    if (framed && choices.size() == 1) {
        choices[0].name = "frames";
        for (std::size_t i = 0; i < planes.size(); ++i)
            choices.push_back({"frame" + std::to_string(i + 1), {planes[i]}, pictureOf(page, false)});
    }
    return choices;
}

// ImageJ writes stacks over 4 GB as one page, behind which the other slices lie without tags of their own.
bool hasRawSlices(const std::string& path, const TiffFile& file, const StackDescription& description,
                  const RunContext& ctx) {
    if (description.kind != StackDescription::Kind::ImageJ || description.images < 2) return false;
    const TiffPage& page = file.pages().front();
    if (page.directoryOffset < page.dataOffset && !page.compressed && !page.planes && page.bits % 8 == 0 &&
        page.bits != 24 && isStored(page, true)) {
        const std::uint64_t behind =
            file.fileBytes() - std::min<std::uint64_t>(file.fileBytes(), page.dataOffset);
        if (!productFits({page.width, page.height, page.samples, page.bits / 8, description.images}, behind))
            throw Error(ErrorCode::BadData, path + ": truncated: its ImageJ description tells of " +
                                                std::to_string(description.images) + " slices");
        return true;
    }
    message(ctx, MessageLevel::Warning,
            path + ": its ImageJ description tells of " + std::to_string(description.images) +
                " slices; the file has one page, which is read alone");
    return false;
}

}  // namespace

TiffContents contentsOf(const std::string& path, TiffFile& file, const RasterReadOptions& options,
                        const RunContext& ctx) {
    TiffContents contents;
    const std::vector<TiffPage>& pages = file.pages();
    RunContext quiet;  // what the user chose needs no word
    const RunContext& say = options.array.empty() ? ctx : quiet;
    const std::vector<Group> groups = groupsOf(path, pages, contents, say);
    Group first = groups.front();
    const TiffPage& page = pages[first.front()];
    if (page.samples == 0) throw Error(ErrorCode::BadData, path + ": has no samples");
    file.select(first.front());
    StackDescription& description = contents.description;
    description = parseStackDescription(file.text(TiffTag::Description), page.width, page.height);
    contents.raw = pages.size() == 1 && hasRawSlices(path, file, description, say);
    if (contents.raw) {
        first.resize(std::size_t(description.images));
        std::iota(first.begin(), first.end(), std::size_t(0));
    } else if (pages.size() == 1 && description.kind == StackDescription::Kind::ImageJ) {
        description = plainStack(description, 1);
    }
    const std::size_t count = contents.raw ? first.size() : pages.size();
    contents.choices = describedChoices(path, contents, first, page, count, say);
    contents.described = contents.choices.size();
    if (groups.size() == 1) return contents;
    sayOtherGroups(path, pages, groups, say);
    if (contents.choices.size() == 1) contents.choices[0].name = pageName(first.front());
    for (std::size_t i = 1; i < groups.size(); ++i) {
        const TiffPage& other = pages[groups[i].front()];
        if (other.samples > 0)
            contents.choices.push_back(
                {pageName(groups[i].front()), groups[i], pictureOf(other, groups[i].size() > 1)});
    }
    return contents;
}

}  // namespace vdbsynth
