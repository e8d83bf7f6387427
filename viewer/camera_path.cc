#include "viewer/camera_path.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

namespace {

enum { LONGITUDE, LATITUDE, HEIGHT, HEADING, PITCH, VALUES };

bool whole_number(const std::string &word, double *number) {
    char *end;
    *number = strtod(word.c_str(), &end);
    return end != word.c_str() && *end == '\0' && std::isfinite(*number);
}

// The angle that differs from `near_deg` by half a turn at most.
double the_shorter_way(double angle_deg, double near_deg) {
    return angle_deg - 360 * floor((angle_deg - near_deg + 180) / 360);
}

} // namespace

bool CameraPath::parse(const std::string &text, std::string *error) {
    std::istringstream lines(text);
    std::string line;
    for (int number = 1; getline(lines, line); number++) {
        std::istringstream words(line.substr(0, line.find('#')));
        double values[6] = {};
        int count = 0;
        bool is_fine = true;
        for (std::string word; words >> word; count++)
            is_fine = is_fine && count < 6 && whole_number(word, &values[count]);
        if (count == 0) continue;
        const std::string where = "line " + std::to_string(number) + ": ";
        if (!is_fine || count != 6) {
            *error = where + "wants six numbers: seconds longitude latitude height_m heading_deg pitch_deg";
            return false;
        }
        if (!is_empty() && !(values[0] > end_s())) {
            *error = where + "times have to grow from line to line";
            return false;
        }
        if (fabs(values[5]) > 90) {
            *error = where + "the pitch has to be within -90 and 90 degrees";
            return false;
        }
        add(values[0], {values[1], values[2], values[3], values[4], values[5]});
    }
    if (is_empty()) {
        *error = "there is no place in it";
        return false;
    }
    return true;
}

std::string CameraPath::text() const {
    std::string text = "# seconds longitude latitude height_m heading_deg pitch_deg\n";
    char line[256];
    for (const Key &key : keys) {
        const double heading_deg = key.values[HEADING] - 360 * floor(key.values[HEADING] / 360);
        snprintf(line, sizeof line, "%.3f %.9f %.9f %.3f %.4f %.4f\n", key.time_s, key.values[LONGITUDE],
                 key.values[LATITUDE], key.values[HEIGHT], heading_deg, key.values[PITCH]);
        text += line;
    }
    return text;
}

void CameraPath::add(double time_s, const CameraPlace &place) {
    Key key = {time_s, {place.lon_deg, place.lat_deg, place.height_m, place.heading_deg, place.pitch_deg}};
    if (!keys.empty()) {
        const Key &last = keys.back();
        if (!(time_s > last.time_s)) return;
        key.values[HEADING] = the_shorter_way(key.values[HEADING], last.values[HEADING]);
        if (has_longitudes) key.values[LONGITUDE] = the_shorter_way(key.values[LONGITUDE], last.values[LONGITUDE]);
    }
    keys.push_back(key);
}

// Change a second at a key.
double CameraPath::slope(size_t key, int value) const {
    const size_t before = key > 0 ? key - 1 : 0, after = std::min(key + 1, keys.size() - 1);
    if (before == after) return 0;
    const auto rise = [&](size_t from, size_t to) {
        return (keys[to].values[value] - keys[from].values[value]) / (keys[to].time_s - keys[from].time_s);
    };
    const double mean = rise(before, after);
    if (value != HEIGHT && value != PITCH) return mean;
    if (before == key || after == key) return mean;
    const double in = rise(before, key), out = rise(key, after);
    if (in * out <= 0) return 0;
    const double most = 3 * std::min(fabs(in), fabs(out));
    return std::max(-most, std::min(most, mean));
}

CameraPlace CameraPath::at(double time_s) const {
    const auto after = std::find_if(keys.begin(), keys.end(), [&](const Key &key) { return key.time_s > time_s; });
    double values[VALUES];
    if (after == keys.begin() || after == keys.end()) {
        const Key &end = after == keys.end() ? keys.back() : keys.front();
        std::copy(end.values, end.values + VALUES, values);
    } else {
        const size_t second = (size_t)(after - keys.begin()), first = second - 1;
        const double span_s = keys[second].time_s - keys[first].time_s, t = (time_s - keys[first].time_s) / span_s;
        for (int i = 0; i < VALUES; i++) {
            const double p = keys[first].values[i], q = keys[second].values[i];
            const double u = slope(first, i) * span_s, v = slope(second, i) * span_s;
            values[i] = p + t * (u + t * (3 * (q - p) - 2 * u - v + t * (2 * (p - q) + u + v)));
        }
    }
    return {values[LONGITUDE], values[LATITUDE], values[HEIGHT], values[HEADING],
            std::max(-90.0, std::min(90.0, values[PITCH]))};
}
