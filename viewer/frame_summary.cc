#include "viewer/frame_summary.h"

#include <algorithm>
#include <cstdio>

namespace {

struct Spread {
    double least, median, p99, most, sum;
};

template <typename Get> Spread spread(const std::vector<Frame> &frames, const Get &get) {
    std::vector<double> values;
    for (const Frame &frame : frames) values.push_back(get(frame));
    std::sort(values.begin(), values.end());
    Spread found = {values.front(), values[(values.size() - 1) / 2], values[(values.size() - 1) * 99 / 100],
                    values.back(), 0};
    for (double value : values) found.sum += value;
    return found;
}

template <typename... Values> void put(std::string *text, const char *format, Values... values) {
    char line[256];
    snprintf(line, sizeof line, format, values...);
    *text += line;
}

} // namespace

double outside_ms(const TerrainFigures &figures) {
    return figures.select_ms + figures.seek_ms + figures.stitch_ms + figures.send_ms;
}

std::string frame_summary(const std::vector<Frame> &frames, uint64_t memory_bytes) {
    if (frames.empty()) return "frames             none\n";
    const Spread all = spread(frames, [](const Frame &frame) { return frame.frame_ms; });
    const Spread outside = spread(frames, [](const Frame &frame) { return outside_ms(frame.figures); });
    const Spread triangles = spread(frames, [](const Frame &frame) { return (double)frame.figures.triangles; });
    const Spread tiles = spread(frames, [](const Frame &frame) { return (double)frame.figures.tiles_drawn; });
    const Spread splits = spread(frames, [](const Frame &frame) { return (double)frame.figures.splits; });
    const Spread sent = spread(frames, [](const Frame &frame) { return (double)frame.figures.bytes_sent; });
    const Spread held = spread(frames, [](const Frame &frame) { return (double)frame.figures.bytes_held; });
    std::string text;
    put(&text, "frames             %zu in %.1f s, %.1f a second\n", frames.size(), all.sum / 1e3,
        1e3 * (double)frames.size() / std::max(all.sum, 1e-9));
    put(&text, "frame time         min %.2f, median %.2f, p99 %.2f, max %.2f ms\n", all.least, all.median, all.p99,
        all.most);
    put(&text, "outside of drawing min %.3f, median %.3f, p99 %.3f, max %.3f ms of CPU time; %.2f %% of the frames\n",
        outside.least, outside.median, outside.p99, outside.most, 100 * outside.sum / std::max(all.sum, 1e-9));
    const char *names[] = {"selection", "splits", "stitching", "uploads"};
    double (*const parts[])(const Frame &) = {[](const Frame &frame) { return frame.figures.select_ms; },
                                              [](const Frame &frame) { return frame.figures.seek_ms; },
                                              [](const Frame &frame) { return frame.figures.stitch_ms; },
                                              [](const Frame &frame) { return frame.figures.send_ms; }};
    for (int i = 0; i < 4; i++) {
        const Spread part = spread(frames, parts[i]);
        put(&text, "  %-16s median %.3f, p99 %.3f, max %.3f ms\n", names[i], part.median, part.p99, part.most);
    }
    put(&text, "splits             %.0f, in one frame at most %.0f\n", splits.sum, splits.most);
    put(&text, "triangles          min %.0f, median %.0f, max %.0f\n", triangles.least, triangles.median,
        triangles.most);
    put(&text, "tiles              min %.0f, median %.0f, max %.0f\n", tiles.least, tiles.median, tiles.most);
    put(&text, "loaded             %.2f MB of files\n", (double)frames.back().figures.bytes_loaded / 1e6);
    put(&text, "sent               %.2f MB to the graphics card, in one frame at most %.3f MB\n", sent.sum / 1e6,
        sent.most / 1e6);
    put(&text, "memory             tiles at most %.1f MB", held.most / 1e6);
    if (memory_bytes > 0) put(&text, ", the process %.1f MB", (double)memory_bytes / 1e6);
    return text + "\n";
}
