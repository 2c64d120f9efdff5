// Rows of numbers: .xyz, .pwn, .pts, .txt, .asc, .csv, .xyzn, .xyzrgb.
#include "libvdbsynth/base/error.h"
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/path.h"
#include "libvdbsynth/io/points/point_columns.h"
#include "libvdbsynth/io/points/row_text.h"

#include <algorithm>
#include <cmath>

namespace vdbsynth {
namespace {

constexpr std::size_t kMostColumns = 256;

class RowReader {
public:
    RowReader(const std::string& path, const std::string& content, const RunContext& ctx)
        : mPath(path), mText(path, content), mContext(ctx) {}

    PointContent read();

private:
    bool readHeader();
    void takeNames(bool comment);
    void refuseOtherKinds(const std::vector<std::string>& names);
    bool isCount() const;
    void beginBlock();
    void endBlock(bool atEnd);
    bool endsWithNormals() const;
    void beginRows();
    void addRow();
    bool addPartialRow();
    void addWords();
    void nameColumns();
    void dropTextColumns();
    PointContent withNormals();
    void say(MessageLevel level, const std::string& what) const {
        message(mContext, level, mPath + ": " + what);
    }

    const std::string& mPath;
    RowText mText;
    const RunContext& mContext;
    PointTable mTable;
    std::vector<double> mNumbers;  // of the present line
    ColumnRoles::Triple mPlace{0, 1, 2};
    std::vector<RowWord> mWords;  // in it
    std::vector<std::string> mCommentNames;
    bool mFirst = true;  // of the lines
    std::size_t mHeaderLines = 0, mHeaderAt = 0, mLongRows = 0;
    std::string mHeaderWord;
    std::vector<std::size_t> mTextRows;  // per column, rows with a word where a number should be
    // Counts of points, as in .pts: of all rows, or of those of a scan.
    std::size_t mBlocks = 0, mClaimed = 0, mBlockRow = 0, mBlockAt = 0, mWrongCounts = 0;
};

// Formats that share an extension with rows of points.
void RowReader::refuseOtherKinds(const std::vector<std::string>& names) {
    std::string first = names.empty() ? "" : names[0].substr(0, names[0].find_first_of(" \t"));
    for (char& c : first) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    if (first == "ncols" || first == "nrows")
        mText.fail("is an ESRI ASCII grid; convert it to .tif, for example with gdal_translate");
    if (first == "dsaa" || first == "dsbb")
        mText.fail("is a Surfer grid; convert it to .tif, for example with gdal_translate");
    const std::string kind = extensionOfContent(std::string(mText.line().substr(0, 40)));
    if (kind == "ply" || kind == "pcd" || kind == "mesh" || kind == "vti" || kind == "inr")
        mText.fail("its content is that of a ." + kind + " file; rename it");
}

void RowReader::takeNames(bool comment) {
    const std::vector<std::string> names = mText.names();
    if (mFirst || !comment) refuseOtherKinds(names);
    mFirst = false;
    if (comment) {
        std::vector<std::string> bare = names;
        // "# x y z": the sign is a word of its own.
        if (!bare.empty() && bare[0].find_first_not_of("#/%! ") == std::string::npos)
            bare.erase(bare.begin());
        if (namePlaces(bare)) mCommentNames = bare;
        return;
    }
    if (mHeaderLines++ == 0) {
        mHeaderAt = mText.position();
        const std::string_view line = mText.line();
        mHeaderWord = shownWord(line.substr(0, line.find_first_of(" \t,;|")));
    }
    if (namePlaces(names)) mTable.names = names;
}

// The lines above the rows; the present line then is the first row, or a count. @return false if none is
bool RowReader::readHeader() {
    constexpr std::size_t kMostLines = 100;
    while (mText.next() && mHeaderLines <= kMostLines) {
        if (mText.isComment()) {
            takeNames(/* comment= */ true);
        } else if (mText.beginsWithNumber()) {
            mText.findDecimalCommas();
            return true;
        } else {
            takeNames(/* comment= */ false);
        }
    }
    if (mHeaderLines == 0 && mBlocks == 0) return false;
    if (mHeaderLines == 0) mText.fail("a count of points and no rows; the file is truncated");
    throw Error(ErrorCode::BadData,
                mPath + ":" + std::to_string(mText.lineNumberAt(mHeaderAt)) + ": " + mHeaderWord +
                    " is not a number, and no rows of numbers follow; a point is a row of three coordinates" +
                    (mBlocks > 0 ? " (atoms of molecules are not read)" : ""));
}

bool RowReader::isCount() const {
    if (mNumbers.size() != 1 || !mWords.empty()) return false;
    return mTable.columns == 0 || (mBlocks > 0 && !mText.isCutOff());
}

void RowReader::beginBlock() {
    const double claimed = mNumbers[0];
    if (!(claimed >= 1) || claimed != std::floor(claimed) || claimed > double(mText.bytesLeft()) / 6 + 1)
        mText.fail("claims more points than the file can hold, or none");
    if (mBlocks > 0 && mBlockRow == mTable.rows())
        mText.fail(mTable.rows() > 0 ? "a count where a row should be"
                                     : "two counts and no rows, as PTX begins, which is not read; save it as "
                                       ".pts or .ply, for example with CloudCompare");
    endBlock(/* atEnd= */ false);
    ++mBlocks;
    mClaimed = std::size_t(claimed);
    mBlockRow = mTable.rows();
    mBlockAt = mText.position();
}

void RowReader::endBlock(bool atEnd) {
    if (mBlocks == 0) return;
    const std::size_t rows = mTable.rows() - mBlockRow;
    mWrongCounts += rows != mClaimed;
    if (atEnd && mWrongCounts > 1)
        say(MessageLevel::Warning, std::to_string(mWrongCounts) + " of its counts are not those of the rows");
    if (rows == mClaimed || mWrongCounts > 1) return;
    say(MessageLevel::Warning, "line " + std::to_string(mText.lineNumberAt(mBlockAt)) + " counts " +
                                   countText(std::size_t(mClaimed), "point") + ", " +
                                   countText(std::size_t(rows), "row") +
                                   (rows == 1 ? " is there" : " are there") +
                                   (atEnd && rows < mClaimed ? "; the file is truncated" : "; all are read"));
}

// At the first row: how many columns there are, and what their names are.
void RowReader::beginRows() {
    const std::size_t columns = mNumbers.size();
    if (columns < 3) mText.fail("a point needs three coordinates, this row has " + std::to_string(columns));
    mTable.columns = std::min(columns, kMostColumns);
    if (columns > kMostColumns)
        say(MessageLevel::Warning, "of its " + std::to_string(columns) + " columns the first " +
                                       std::to_string(kMostColumns) + " are read");
    nameColumns();
    const double lines = double(mText.bytesLeft()) / double(mText.line().size() + 1);
    mTable.values.reserve(std::size_t(std::min(lines * 1.02, double(mText.bytesLeft()) / 6) + 1) *
                          mTable.columns);
    mTextRows.assign(mTable.columns, 0);
}

void RowReader::nameColumns() {
    const std::size_t columns = mTable.columns;
    if (mTable.names.empty() && mCommentNames.size() == columns) mTable.names = mCommentNames;
    // Names beyond the columns can be of nothing; places must be among the columns.
    if (mTable.names.size() > columns) {
        say(MessageLevel::Warning, "its header names " + std::to_string(mTable.names.size()) +
                                       " columns, its rows have " + std::to_string(columns));
        mTable.names.resize(columns);
        if (!namePlaces(mTable.names)) mTable.names.clear();
    }
    if (mTable.names.empty() && mHeaderLines > 0)
        say(MessageLevel::Note, countText(std::size_t(mHeaderLines), "line") +
                                    " above its rows skipped, without names of columns x, y and z");
    // These extensions say what the columns are.
    const std::string extension = readExtensionOf(mPath);
    if (mTable.names.empty() && columns == 6 && extension == "xyzn")
        mTable.names = {"x", "y", "z", "nx", "ny", "nz"};
    if (mTable.names.empty() && columns == 6 && extension == "xyzrgb")
        mTable.names = {"x", "y", "z", "r", "g", "b"};
    mPlace = rolesByName(mTable.names, columns).place;
}

// Words where numbers should be are fine in columns that are not coordinates.
void RowReader::addWords() {
    for (const RowWord& word : mWords) {
        if (word.place >= mTable.columns) continue;
        if (std::find(mPlace.begin(), mPlace.end(), word.place) != mPlace.end())
            mText.fail(shownWord(word.text) + " is not a number");
        ++mTextRows[word.place];
    }
}

// The last row of a file that was cut off. @return false if this is none
bool RowReader::addPartialRow() {
    const bool lacks =
        mNumbers.size() < mTable.columns ||
        (!mWords.empty() && mWords.back().place + 1 == mTable.columns && mTextRows[mWords.back().place] == 0);
    if (!lacks || !mText.isCutOff() || mTable.rows() == 0) return false;
    say(MessageLevel::Warning, "line " + std::to_string(mText.lineNumber()) +
                                   ", the last, is cut off and left out; the file is truncated after " +
                                   std::to_string(mTable.rows()) + " points");
    return true;
}

void RowReader::addRow() {
    // Nothing behind the last separator is a missing number where the others have one.
    const std::size_t wanted = mTable.columns > 0 ? mTable.columns : mTable.names.size();
    if (mNumbers.size() + 1 == wanted && mText.endsWithSeparator()) mNumbers.push_back(std::nan(""));
    if (mTable.columns == 0) beginRows();
    if (mNumbers.size() != mTable.columns || !mWords.empty()) {
        if (addPartialRow()) return;
        if (mNumbers.size() < mTable.columns)
            mText.fail("a row of " + std::to_string(mNumbers.size()) + " numbers where the first has " +
                       std::to_string(mTable.columns));
        mLongRows += mNumbers.size() > mTable.columns && mTable.columns < kMostColumns;
        if (!mWords.empty()) addWords();
    }
    mTable.values.insert(mTable.values.end(), mNumbers.begin(),
                         mNumbers.begin() + std::ptrdiff_t(mTable.columns));
}

void RowReader::dropTextColumns() {
    std::vector<std::size_t> kept;
    for (std::size_t column = 0; column < mTextRows.size(); ++column) {
        if (mTextRows[column] == 0)
            kept.push_back(column);
        else
            say(MessageLevel::Note, "column " + std::to_string(column + 1) +
                                        " left out, for it holds words in " +
                                        countText(std::size_t(mTextRows[column]), "row"));
    }
    if (kept.size() == mTable.columns) return;
    PointTable table;
    table.columns = kept.size();
    for (std::size_t at = 0; at < mTable.values.size(); at += mTable.columns)
        for (const std::size_t column : kept) table.values.push_back(mTable.values[at + column]);
    for (const std::size_t column : kept)
        if (column < mTable.names.size()) table.names.push_back(mTable.names[column]);
    mTable = std::move(table);
}

// A count, that many points, that many normals: only where the count is of half the rows, each of three
// numbers, and the rest are unit vectors or the file is a .pwn.
bool RowReader::endsWithNormals() const {
    if (mBlocks != 1 || mTable.columns != 3 || mTable.rows() <= mClaimed || mTable.rows() > 2 * mClaimed)
        return false;
    if (readExtensionOf(mPath) == "pwn") return true;
    for (std::size_t at = mClaimed * 3; at < mTable.values.size(); at += 3) {
        const Vec3d v{mTable.values[at], mTable.values[at + 1], mTable.values[at + 2]};
        if (!(std::abs(length(v) - 1) < 0.02)) return false;
    }
    return true;
}

PointContent RowReader::withNormals() {
    const std::size_t normals = mTable.rows() - mClaimed;
    PointContent cloud;
    const auto vector = [&](std::size_t row) {
        const double* at = &mTable.values[row * 3];
        return Vec3d{at[0], at[1], at[2]};
    };
    for (std::size_t i = 0; i < mClaimed; ++i) cloud.points.push_back(vector(i));
    if (normals < mClaimed)
        say(MessageLevel::Warning, "holds normals of " + std::to_string(normals) + " of its " +
                                       std::to_string(mClaimed) +
                                       " points; the file is truncated, its normals left out");
    else
        for (std::size_t i = 0; i < mClaimed; ++i) cloud.normals.push_back(cast<float>(vector(mClaimed + i)));
    return cloud;
}

PointContent RowReader::read() {
    bool more = readHeader();
    while (more) {
        mNumbers.clear();
        mWords.clear();
        if (!mText.isComment()) mText.numbers(mNumbers, mWords);
        if (isCount()) {
            beginBlock();
            more = mTable.columns == 0 ? readHeader() : mText.next();
            continue;
        }
        if (!mNumbers.empty()) addRow();
        more = mText.next();
    }
    if (mText.decimalCommas())
        say(MessageLevel::Note, "commas read as decimal points, which gives rows of " +
                                    std::to_string(mTable.columns) + " numbers");
    if (endsWithNormals()) return withNormals();
    endBlock(/* atEnd= */ true);
    if (mLongRows > 0)
        say(MessageLevel::Warning, std::to_string(mLongRows) + " rows have more than the " +
                                       std::to_string(mTable.columns) +
                                       " numbers of the first; those beyond are left out");
    dropTextColumns();
    return contentOf(mPath, mTable, mContext);
}

}  // namespace

PointContent readRows(const std::string& path, const std::string& content, const RunContext& ctx) {
    return RowReader(path, content, ctx).read();
}

}  // namespace vdbsynth
