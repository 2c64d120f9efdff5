// VTK ImageData in XML, its samples appended raw.
#include "libvdbsynth/base/number_text.h"
#include "libvdbsynth/io/writers/volume_writers.h"

namespace vdbsynth {

VolumeFrame vtiFrame(const VolumeHead& head) {
    const double cell = cellOf(head);
    std::string extent;
    for (int axis = 0; axis < 3; ++axis)
        extent += std::string(axis ? " " : "") + "0 " + std::to_string(head.size[axis] - 1);
    const auto place = [&](std::size_t row) { return exactText(head.toWorld[12 + row]); };
    std::string direction;
    // VTK before 9 knows no Direction, so it is written only where it is needed.
    if (!runsAlongWorld(head)) {
        direction = " Direction=\"";
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t column = 0; column < 3; ++column)
                direction += (row + column > 0 ? " " : "") + exactText(head.toWorld[4 * column + row] / cell);
        direction += "\"";
    }
    VolumeFrame frame;
    frame.head =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n<ImageData WholeExtent=\"" +
        extent + "\" Origin=\"" + place(0) + " " + place(1) + " " + place(2) + "\" Spacing=\"" +
        exactText(cell) + " " + exactText(cell) + " " + exactText(cell) + "\"" + direction +
        ">\n<Piece Extent=\"" + extent + "\">\n<PointData Scalars=\"" + head.name +
        "\">\n<DataArray type=\"" + (head.bytes ? "UInt8" : "Float32") + "\" Name=\"" + head.name +
        "\" NumberOfComponents=\"1\" format=\"appended\" offset=\"0\"/>\n</PointData>\n</Piece>\n"
        "</ImageData>\n<AppendedData encoding=\"raw\">\n_";
    appendLittle(frame.head, sampleBytes(head), 8);
    frame.tail = "\n</AppendedData>\n</VTKFile>\n";
    return frame;
}

}  // namespace vdbsynth
