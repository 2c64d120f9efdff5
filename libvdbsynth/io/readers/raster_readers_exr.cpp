#include "libvdbsynth/base/checked_product.h"
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/io/raster_file.h"
#include "libvdbsynth/io/readers/raster_readers.h"
#include "libvdbsynth/io/readers/whole_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfThreading.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vdbsynth {
namespace {

class MemoryIn : public Imf::IStream {
public:
    MemoryIn(const std::string& path, const std::string& content)
        : IStream(path.c_str()), mContent(content) {}
    bool read(char* out, int count) override {
        if (count < 0 || mAt > mContent.size() || std::size_t(count) > mContent.size() - mAt)
            throw std::runtime_error("truncated");
        std::copy_n(mContent.data() + mAt, count, out);
        mAt += std::size_t(count);
        return mAt < mContent.size();
    }
    std::uint64_t tellg() override { return mAt; }
    void seekg(std::uint64_t at) override { mAt = std::size_t(at); }

private:
    const std::string& mContent;
    std::size_t mAt = 0;
};

class MemoryOut : public Imf::OStream {
public:
    explicit MemoryOut(const std::string& path) : OStream(path.c_str()) {}
    void write(const char* bytes, int count) override {
        if (mAt + std::size_t(count) > content.size()) content.resize(mAt + std::size_t(count));
        std::copy_n(bytes, count, content.begin() + std::ptrdiff_t(mAt));
        mAt += std::size_t(count);
    }
    std::uint64_t tellp() override { return mAt; }
    void seekp(std::uint64_t at) override { mAt = std::size_t(at); }
    std::string content;

private:
    std::size_t mAt = 0;
};

// What heights can be read from, by the name that chooses it.
struct Choices {
    std::vector<std::string> names{};
    std::vector<std::vector<std::string>> channels{};

    void add(const std::string& name, const std::vector<std::string>& of) {
        names.push_back(name);
        // Messages show the file's names.
        for (char& c : names.back())
            if (c < ' ' || c > '~') c = '?';
        channels.push_back(of);
    }
};

// First the one that is read by default: Y, else R G B, else the first channel.
Choices choicesOf(const std::string& path, const Imf::ChannelList& list) {
    Choices choices;
    const std::string luminance = "Y";
    if (list.findChannel(luminance)) choices.add(luminance, {luminance});
    const bool colour = list.findChannel("R") && list.findChannel("G") && list.findChannel("B");
    if (colour) choices.add("RGB", {"R", "G", "B"});
    for (auto it = list.begin(); it != list.end(); ++it) {
        const std::string name = it.name();
        const bool shown =
            name == "A" || name == luminance || (colour && (name == "R" || name == "G" || name == "B"));
        if (!shown) choices.add(name, {name});
    }
    if (choices.names.empty()) throw Error(ErrorCode::BadData, path + ": has no channel but alpha");
    return choices;
}

void checkSubsampling(const std::string& path, const Imf::ChannelList& list, const std::string& name) {
    const Imf::Channel* channel = list.findChannel(name);
    if (channel && (channel->xSampling != 1 || channel->ySampling != 1))
        throw Error(ErrorCode::BadData,
                    path + ": channel " + name + " is subsampled; store it at full resolution");
}

// @return true if the file's version says that it has several images
bool hasParts(const std::string& content) {
    constexpr std::size_t kFlags = 5;
    constexpr int kMultipart = 16;
    return content.size() > kFlags && (content[kFlags] & kMultipart) != 0;
}

Raster readPixels(const std::string& path, const std::string& content, const RasterReadOptions& options,
                  const RunContext& ctx) {
    MemoryIn stream(path, content);
    Imf::InputFile file(stream);
    const Imf::Header& header = file.header();
    const Imath::Box2i window = header.dataWindow();
    const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1,
                       height = std::int64_t(window.max.y) - window.min.y + 1;
    const Choices choices = choicesOf(path, header.channels());
    const std::vector<std::string>& names =
        choices.channels[chosenArray(path, choices.names, 0, options, ctx)];
    if (hasParts(content))
        message(ctx, MessageLevel::Note, path + ": holds several images (parts), of which the first is read");
    // The strongest compression gives a few thousandths; a line table alone needs
    // eight bytes per chunk of lines.
    if (!productFits({width, height}, 4000 * content.size()))
        throw Error(ErrorCode::BadData, path + ": truncated");
    Raster raster = makeRaster(path, width, height, 1, int(names.size()), ctx);
    raster.rowsFromTop = true;
    if (choices.names.size() > 1) raster.arrays = choices.names;
    std::vector<float> alpha(raster.sampleCount(), 1.f);
    Imf::FrameBuffer frame;
    const auto add = [&](const std::string& name, float* values, std::size_t channels) {
        checkSubsampling(path, header.channels(), name);
        const std::size_t step = channels * sizeof(float), row = step * std::size_t(width);
        frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values, window, step, row, 1, 1, 1.0));
    };
    for (std::size_t c = 0; c < names.size(); ++c) add(names[c], raster.values.data() + c, names.size());
    add("A", alpha.data(), 1);
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    for (std::size_t i = 0; i < alpha.size(); ++i)
        for (std::size_t c = 0; alpha[i] == 0 && c < names.size(); ++c)
            raster.values[i * names.size() + c] = std::nanf("");
    return raster;
}

}  // namespace

Raster readExr(const std::string& path, const std::string& content, const RasterReadOptions& options,
               const RunContext& ctx) {
    if (content.compare(0, 4, "\x76\x2f\x31\x01") != 0)
        throw Error(ErrorCode::BadData, path + ": not an OpenEXR image");
    try {
        return readPixels(path, content, options, ctx);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        throw Error(ErrorCode::BadData, path + ": not a whole OpenEXR image: " + error.what());
    }
}

void writeGreyExr(const std::string& path, int width, int height, const std::vector<float>& values) {
    std::vector<float> heights = values, alpha(values.size(), 1.f);
    bool missing = false;
    for (std::size_t i = 0; i < heights.size(); ++i)
        if (std::isnan(heights[i])) {
            heights[i] = alpha[i] = 0;
            missing = true;
        }
    MemoryOut stream(path);
    {
        Imf::Header header(width, height);
        header.compression() = Imf::ZIP_COMPRESSION;
        const auto slice = [&](std::vector<float>& of) {
            return Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(of.data()), sizeof(float),
                              sizeof(float) * std::size_t(width));
        };
        Imf::FrameBuffer frame;
        header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
        frame.insert("Y", slice(heights));
        if (missing) {
            header.channels().insert("A", Imf::Channel(Imf::FLOAT));
            frame.insert("A", slice(alpha));
        }
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(height);
    }
    writeWholeFile(path, stream.content);
}

void writeImageExr(const std::string& path, int width, int height, int channels,
                   const std::vector<float>& values) {
    MemoryOut stream(path);
    {
        Imf::Header header(width, height);
        header.compression() = Imf::ZIP_COMPRESSION;
        const std::size_t step = sizeof(float) * std::size_t(channels);
        std::vector<float> copied = values;
        const char* const names[] = {"R", "G", "B"};
        Imf::FrameBuffer frame;
        for (int c = 0; c < channels; ++c) {
            const char* name = channels == 1 ? "Y" : names[c];
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(copied.data() + c), step,
                                          step * std::size_t(width)));
        }
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frame);
        file.writePixels(height);
    }
    writeWholeFile(path, stream.content);
}

}  // namespace vdbsynth
