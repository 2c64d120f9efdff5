#include "libvdbsynth/render/drawn_text.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace vdbsynth {
namespace {

// A letter: its width, then strokes parted by '/', each a row of places parted by spaces. A place is two
// hexadecimal digits, across and up. Letters stand on 3, small ones reach 9, capital ones c, tails 0.
struct Glyph {
    char letter;
    int width;
    const char* strokes;
};

constexpr int kBase = 3, kCapital = 9;
constexpr double kGap = 2.4, kSpace = 2.6;  // between letters, and what an empty place adds
constexpr const char* kBox = "03 0c 5c 53 03";

constexpr Glyph kGlyphs[] = {
    {'!', 0, "0c 06/03 03"},
    {'"', 2, "0c 0a/2c 2a"},
    {'#', 6, "13 2c/43 5c/06 56/19 69"},
    {'$', 5, "5a 4b 3c 2c 1b 0a 09 18 47 56 55 44 33 23 14 05/2d 32"},
    {'%', 6, "03 6c/1c 0b 0a 19 2a 2b 1c/56 45 44 53 64 65 56"},
    {'&', 6, "63 19 1b 2c 3b 3a 07 05 14 23 33 66"},
    {'\'', 0, "0c 0a"},
    {'(', 2, "2d 1b 09 06 14 22"},
    {')', 2, "0d 1b 29 26 14 02"},
    {'*', 4, "2b 27/0a 48/4a 08"},
    {'+', 4, "07 47/25 29"},
    {',', 1, "13 01"},
    {'-', 3, "07 37"},
    {'.', 0, "03 03"},
    {'/', 4, "03 4c"},
    {'0', 5, "2c 3c 4b 59 56 44 33 23 14 06 09 1b 2c"},
    {'1', 2, "0a 2c 23"},
    {'2', 5, "0a 1b 2c 3c 4b 5a 59 48 03 53"},
    {'3', 5, "0b 1c 3c 4b 5a 49 38 28/38 47 56 55 44 33 13 04"},
    {'4', 5, "43 4c 06 56"},
    {'5', 5, "5c 0c 08 38 47 56 55 44 33 13 04"},
    {'6', 5, "4c 2b 18 06 05 14 23 33 44 55 56 47 38 28 17 06"},
    {'7', 5, "0c 5c 23"},
    {'8', 5, "28 19 1b 2c 3c 4b 49 38 28/28 17 06 05 14 23 33 44 55 56 47 38"},
    {'9', 5, "13 34 47 59 5a 4b 3c 2c 1b 0a 09 18 27 37 48 59"},
    {':', 0, "04 04/08 08"},
    {';', 1, "14 02/18 18"},
    {'<', 4, "49 06 43"},
    {'=', 4, "06 46/08 48"},
    {'>', 4, "09 46 03"},
    {'?', 4, "0a 1c 3c 4a 49 27 26/23 23"},
    {'@', 7, "58 48 37 36 45 55 58 56 65 76 79 6b 5c 3c 1b 09 06 14 33 53"},
    {'A', 6, "03 3c 63/16 56"},
    {'B', 6, "03 0c 4c 5b 59 48 08/48 57 66 65 54 43 03"},
    {'C', 6, "6a 5b 4c 2c 1b 09 06 14 23 43 54 65"},
    {'D', 6, "03 0c 3c 5b 69 66 54 33 03"},
    {'E', 5, "5c 0c 03 53/08 48"},
    {'F', 5, "5c 0c 03/08 48"},
    {'G', 6, "6a 5b 4c 2c 1b 09 06 14 23 43 54 65 67 47"},
    {'H', 6, "0c 03/6c 63/08 68"},
    {'I', 0, "0c 03"},
    {'J', 4, "4c 45 34 23 13 04 05"},
    {'K', 6, "0c 03/6c 06/28 63"},
    {'L', 5, "0c 03 53"},
    {'M', 6, "03 0c 35 6c 63"},
    {'N', 6, "03 0c 63 6c"},
    {'O', 6, "2c 4c 5b 69 66 54 43 23 14 06 09 1b 2c"},
    {'P', 6, "03 0c 4c 5b 6a 69 58 47 07"},
    {'Q', 6, "2c 4c 5b 69 66 54 43 23 14 06 09 1b 2c/45 62"},
    {'R', 6, "03 0c 4c 5b 6a 69 58 47 07/37 63"},
    {'S', 5, "5a 4b 3c 2c 1b 0a 09 18 47 56 55 44 33 23 14 05"},
    {'T', 6, "0c 6c/3c 33"},
    {'U', 6, "0c 06 14 23 43 54 66 6c"},
    {'V', 6, "0c 33 6c"},
    {'W', 8, "0c 23 4b 63 8c"},
    {'X', 6, "0c 63/6c 03"},
    {'Y', 6, "0c 38 6c/38 33"},
    {'Z', 6, "0c 6c 03 63"},
    {'[', 2, "2d 0d 02 22"},
    {'\\', 4, "0c 43"},
    {']', 2, "0d 2d 22 02"},
    {'^', 4, "09 2c 49"},
    {'_', 5, "01 51"},
    {'`', 1, "0c 1a"},
    {'a', 5, "59 53/57 48 39 29 18 07 05 14 23 33 44 55"},
    {'b', 5, "0c 03/05 14 23 33 44 55 57 48 39 29 18 07"},
    {'c', 4, "48 39 29 18 07 05 14 23 33 44"},
    {'d', 5, "5c 53/57 48 39 29 18 07 05 14 23 33 44 55"},
    {'e', 5, "06 56 57 48 39 29 18 07 05 14 23 33 44"},
    {'f', 4, "4c 3c 2b 23/09 49"},
    {'g', 5, "59 52 41 30 20 11/57 48 39 29 18 07 05 14 23 33 44 55"},
    {'h', 5, "0c 03/07 18 29 39 48 57 53"},
    {'i', 0, "09 03/0c 0c"},
    {'j', 2, "29 21 10 00/2c 2c"},
    {'k', 4, "0c 03/49 05/16 43"},
    {'l', 1, "0c 04 13"},
    {'m', 6, "09 03/07 19 29 38 33/37 49 59 68 63"},
    {'n', 5, "09 03/07 18 29 39 48 57 53"},
    {'o', 5, "29 39 48 57 55 44 33 23 14 05 07 18 29"},
    {'p', 5, "09 00/07 18 29 39 48 57 55 44 33 23 14 05"},
    {'q', 5, "59 50/57 48 39 29 18 07 05 14 23 33 44 55"},
    {'r', 3, "09 03/07 18 29 39"},
    {'s', 4, "48 39 19 08 07 16 36 45 44 33 13 04"},
    {'t', 3, "1c 14 23 33/09 39"},
    {'u', 5, "09 05 14 23 33 44 55/59 53"},
    {'v', 4, "09 23 49"},
    {'w', 6, "09 23 38 43 69"},
    {'x', 4, "09 43/49 03"},
    {'y', 4, "09 23/49 10 00"},
    {'z', 4, "09 49 03 43"},
    {'{', 2, "2d 1b 19 08 07 16 14 22"},
    {'|', 0, "0d 02"},
    {'}', 2, "0d 1b 19 28 27 16 14 02"},
    {'~', 4, "06 17 36 47"},
};

const Glyph* glyphOf(char letter) {
    for (const Glyph& glyph : kGlyphs)
        if (glyph.letter == letter) return &glyph;
    return nullptr;
}

bool continues(char c) {
    return (static_cast<unsigned char>(c) & 0xc0) == 0x80;  // a further byte of one character
}

struct Letter {
    const char* strokes;  // null: empty
    double width;
};

Letter letterOf(char c) {
    if (c == ' ') return {nullptr, kSpace};
    const Glyph* glyph = glyphOf(c);
    return glyph ? Letter{glyph->strokes, double(glyph->width)} : Letter{kBox, 5};
}

struct Segment {
    double ax, ay, bx, by;  // [pixels]
};

std::vector<Segment> segmentsOf(const char* strokes, double left, double base, double unit) {
    const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
    std::vector<Segment> segments;
    bool begun = false;
    double x = 0, y = 0;
    for (const char* at = strokes; *at;) {
        if (*at == '/' || *at == ' ') {
            begun = begun && *at == ' ';
            ++at;
            continue;
        }
        const double nextX = left + digit(at[0]) * unit, nextY = base - (digit(at[1]) - kBase) * unit;
        if (begun) segments.push_back({x, y, nextX, nextY});
        x = nextX;
        y = nextY;
        begun = true;
        at += 2;
    }
    return segments;
}

double distanceTo(const Segment& s, double x, double y) {
    const double dx = s.bx - s.ax, dy = s.by - s.ay, squared = dx * dx + dy * dy;
    const double t = squared > 0 ? std::clamp(((x - s.ax) * dx + (y - s.ay) * dy) / squared, 0.0, 1.0) : 0.0;
    const double ox = x - s.ax - t * dx, oy = y - s.ay - t * dy;
    return std::sqrt(ox * ox + oy * oy);
}

void drawSegments(Picture& picture, const std::vector<Segment>& segments, double radius,
                  const PictureColour& colour) {
    double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
    for (const Segment& s : segments) {
        left = std::min({left, s.ax, s.bx});
        right = std::max({right, s.ax, s.bx});
        top = std::min({top, s.ay, s.by});
        bottom = std::max({bottom, s.ay, s.by});
    }
    for (int y = int(top - radius) - 1; y <= int(bottom + radius) + 1; ++y)
        for (int x = int(left - radius) - 1; x <= int(right + radius) + 1; ++x) {
            double nearest = 1e9;
            for (const Segment& s : segments) nearest = std::min(nearest, distanceTo(s, x + 0.5, y + 0.5));
            blendPixel(picture, x, y, colour, std::clamp(radius + 0.5 - nearest, 0.0, 1.0));
        }
}

}  // namespace

void blendPixel(Picture& picture, int x, int y, const PictureColour& colour, double share) {
    if (share <= 0 || x < 0 || y < 0 || x >= picture.width || y >= picture.height) return;
    const std::size_t channels = std::size_t(picture.channels);
    std::uint8_t* pixel =
        &picture.pixels[(std::size_t(y) * std::size_t(picture.width) + std::size_t(x)) * channels];
    double under = 1 - share;
    if (channels == 4) {
        // Colours of transparent pixels count as much as these are opaque.
        const double before = pixel[3] / 255.0, after = share + before * (1 - share);
        pixel[3] = std::uint8_t(after * 255 + 0.5);
        under = before * (1 - share) / after;
    }
    for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = std::uint8_t(pixel[c] * under + colour[c] * (1 - under) + 0.5);
}

void blendRectangle(Picture& picture, int left, int top, int right, int bottom, const PictureColour& colour,
                    double share) {
    for (int y = std::max(0, top); y < std::min(bottom, picture.height); ++y)
        for (int x = std::max(0, left); x < std::min(right, picture.width); ++x)
            blendPixel(picture, x, y, colour, share);
}

int textWidth(const std::string& text, int size) {
    double units = 0;
    for (char c : text)
        if (!continues(c)) units += letterOf(c).width + kGap;
    return units > 0 ? int(std::ceil((units - kGap) * size / kCapital)) : 0;
}

void drawText(Picture& picture, const std::string& text, int left, int base, int size,
              const PictureColour& colour) {
    const double unit = double(size) / kCapital, radius = std::max(0.45, size * 0.062);
    double at = left;
    for (char c : text) {
        if (continues(c)) continue;
        const Letter letter = letterOf(c);
        if (letter.strokes) drawSegments(picture, segmentsOf(letter.strokes, at, base, unit), radius, colour);
        at += (letter.width + kGap) * unit;
    }
}

bool hasLetters(const std::string& text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c == ' ' || glyphOf(c); });
}

}  // namespace vdbsynth
