// SPDX-License-Identifier: BSD-3-Clause
#include "core/trajectory_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/number_text.hpp"
#include "core/stamp.hpp"
#include "core/text_file.hpp"

namespace planemap {

namespace {

constexpr std::size_t kTumColumns = 8, kKittiColumns = 12, kEurocColumns = 17;
constexpr std::int64_t kIndexStepUs = 1000000;  // between poses that have no timestamps
constexpr double kFarthest_m = 1e8;             // beyond any place on Earth, in any map's coordinates
constexpr double kLengthTolerance = 0.01;       // of a unit quaternion that was written with two digits

/// Where a line holds what.
struct Columns {
    std::size_t timestamp = 0;
    std::array<std::size_t, 3> position{1, 2, 3};
    std::array<std::size_t, 4> quaternion{4, 5, 6, 7};  ///< x y z w

    std::size_t count() const {
        return 1 + std::max({timestamp, *std::max_element(position.begin(), position.end()),
                             *std::max_element(quaternion.begin(), quaternion.end())});
    }
};
constexpr Columns kTum, kEuroc{0, {1, 2, 3}, {5, 6, 7, 4}};

std::vector<std::string_view> split(std::string_view line, std::string_view separators) {
    std::vector<std::string_view> fields;
    for (std::size_t at = 0; (at = line.find_first_not_of(separators, at)) != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
        fields.push_back(line.substr(at, end - at));
        at = end;
    }
    return fields;
}

/// The numbers that the line begins with, as text.
std::vector<std::string_view> leading_numbers(std::string_view line) {
    std::vector<std::string_view> fields = split(line, ", \t\r");
    const auto is_number = [](std::string_view text) {
        if (text.starts_with('+')) text.remove_prefix(1);
        double value = 0;
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        return error != std::errc::invalid_argument && stop == text.data() + text.size();
    };
    fields.erase(std::find_if_not(fields.begin(), fields.end(), is_number), fields.end());
    return fields;
}

/// A header's name of a column in small letters, without its unit: " q_RS_w []" gives "q_rs_w".
std::string column_name(std::string_view text) {
    std::string name;
    for (const char c : text.substr(0, text.find('['))) {
        const char small = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        if ((small >= 'a' && small <= 'z') || small == '_' || small == '.') name += small;
    }
    return name;
}

/// What a header line says of the columns; nothing for a line that names no pose.
struct Header {
    Columns columns;
    std::optional<StampUnit> unit;
    bool commas = false;
};

std::optional<Header> parse_header(std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of("#% \t"), line.size()));
    const bool commas = split(line, ",").size() >= kTumColumns;
    const std::vector<std::string_view> fields = split(line, commas ? "," : " \t\r");
    if (fields.size() < kTumColumns || !column_name(fields[0]).starts_with("time")) return std::nullopt;

    constexpr std::size_t kMissing = static_cast<std::size_t>(-1);
    Header header{{0, {kMissing, kMissing, kMissing}, {kMissing, kMissing, kMissing, kMissing}}, {}, commas};
    for (std::size_t i = 1; i < fields.size(); ++i) {
        const std::string name = column_name(fields[i]);
        if (name.empty()) continue;
        const std::size_t axis = std::string_view("xyzw").find(name.back());
        std::string what = name.substr(0, name.size() - 1);
        while (!what.empty() && (what.back() == '_' || what.back() == '.')) what.pop_back();
        const auto is_any = [&](std::initializer_list<const char*> words) {
            return std::find(words.begin(), words.end(), what) != words.end();
        };
        const bool position =
            is_any({"", "t", "p", "pos", "position", "trans", "translation"}) || what.starts_with("p_");
        const bool rotation =
            is_any({"q", "quat", "quaternion", "rot", "rotation", "orientation"}) || what.starts_with("q_");
        if (axis > 3) continue;
        if (rotation && header.columns.quaternion[axis] == kMissing) header.columns.quaternion[axis] = i;
        if (position && axis < 3 && header.columns.position[axis] == kMissing)
            header.columns.position[axis] = i;
    }
    if (header.columns.count() == 0) return std::nullopt;  // 1 + kMissing: a part of a pose has no name
    for (const auto& [name, unit] : {std::pair("[s]", StampUnit::kSeconds),
                                     {"[ms]", StampUnit::kMilliseconds},
                                     {"[us]", StampUnit::kMicroseconds},
                                     {"[ns]", StampUnit::kNanoseconds}}) {
        if (fields[0].find(name) != std::string_view::npos) header.unit = unit;
    }
    return header;
}

/// The name of a form that others write and that is not read here, by how many numbers a line has.
std::string known_form(std::string_view line, std::size_t numbers) {
    if (numbers == 0 && line.find_first_of("{[") == line.find_first_not_of(" \t")) return "JSON";
    switch (numbers) {
        case 3:
            return "3 numbers a line: positions alone, or a trajectory of Redwood (.log)";
        case 4:
            return "4 numbers a line: a 4 x 4 matrix a pose, over four lines";
        case 7:
            return "7 numbers a line: poses without timestamps";
        case 13:
            return "13 numbers a line: KITTI-360's poses with a frame number in front";
        case 16:
        case 17:
            return std::to_string(numbers) + " numbers a line: 4 x 4 matrices";
        default:
            return std::to_string(numbers) + " numbers a line";
    }
}

/// A number in the unit as one in seconds, which read_stamp() takes for such; for those without exponent.
std::string in_seconds(std::string_view text, StampUnit unit) {
    const char* exponents[] = {"", "e-3", "e-6", "e-9"};
    return std::string(text) + exponents[static_cast<int>(unit)];
}

double number(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() ? value : std::numeric_limits<double>::infinity();  // out of range
}

std::string count_text(std::size_t count, const char* one, const char* more) {
    return std::to_string(count) + " " + (count == 1 ? one : more);
}

class Reader {
  public:
    explicit Reader(const std::filesystem::path& file) : file_(file) {}

    TrajectoryFile read() {
        std::istringstream in(read_text_file(file_));
        for (std::string line; std::getline(in, line);) {
            ++number_;
            take(line);
        }
        std::stable_sort(result_.poses.begin(), result_.poses.end(),
                         [](const auto& a, const auto& b) { return a.utime < b.utime; });
        note_repeated_stamps();
        return std::move(result_);
    }

  private:
    [[noreturn]] void fail(const std::string& reason) const {
        throw std::runtime_error(file_.string() + ":" + std::to_string(number_) + ": " + reason);
    }

    void take(std::string_view line) {
        const auto start = line.find_first_not_of(" \t\r");
        if (start == std::string_view::npos) return;
        const std::vector<std::string_view> numbers = leading_numbers(line);
        if (columns_ == 0 && numbers.empty()) {
            if (const auto header = parse_header(line)) {
                header_ = header;
                return;
            }
        }
        if (line[start] == '#') return;
        if (columns_ == 0) choose_form(line, numbers);
        check_count(numbers.size());
        std::vector<double> values(numbers.size());
        std::transform(numbers.begin(), numbers.end(), values.begin(), number);
        if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); }))
            fail("a value is not finite; expected " + expected());
        if (result_.format == TrajectoryFormat::kKitti) {
            take_matrix(values);
        } else {
            take_stamped(values, numbers);
        }
    }

    void choose_form(std::string_view line, const std::vector<std::string_view>& numbers) {
        const bool commas = line.find(',') != std::string_view::npos;
        const std::size_t count = numbers.size();
        columns_ = count;
        if (header_) {
            order_ = header_->columns;
            columns_ = order_.count();
            const bool scalar_first = order_.quaternion[3] < order_.quaternion[0];
            result_.format = commas && scalar_first ? TrajectoryFormat::kEuroc : TrajectoryFormat::kTum;
        } else if (commas && count >= kEurocColumns) {
            order_ = kEuroc;
            result_.format = TrajectoryFormat::kEuroc;
        } else if (count == kKittiColumns) {
            result_.format = TrajectoryFormat::kKitti;
        } else if (count != kTumColumns) {
            const std::string form = known_form(line, count);
            const bool torn = count < kTumColumns && form.find(':') == std::string::npos && form != "JSON";
            fail((torn ? "" : form + "; ") + ("expected " + expected()));
        } else if (commas && std::abs(number(numbers[0])) > 1e17) {
            fail(
                "comma-separated poses without a header line: it is not known whether the quaternion is w x "
                "y z "
                "(EuRoC) or x y z w; a first line `#timestamp [ns],p_x,p_y,p_z,q_w,q_x,q_y,q_z` says it");
        }
    }

    void check_count(std::size_t count) const {
        // Comma-separated files may have more columns than are used; others end in what is a comment.
        const bool more = header_ ? header_->commas : result_.format == TrajectoryFormat::kEuroc;
        if (more ? count >= order_.count() : count == columns_) return;
        fail(std::to_string(count) + " numbers, in a file of " + format_name(result_.format) +
             "'s form; expected " + expected());
    }

    std::string expected() const {
        if (columns_ == 0 || (!header_ && columns_ != kTumColumns && columns_ != kKittiColumns &&
                              result_.format == TrajectoryFormat::kTum)) {
            return "eight finite numbers: timestamp tx ty tz qx qy qz qw (TUM), 12: a 3 x 4 matrix row by "
                   "row "
                   "(KITTI), or EuRoC's comma-separated columns under their header line";
        }
        if (result_.format == TrajectoryFormat::kKitti) return "12 finite numbers: a 3 x 4 matrix row by row";
        if (header_ || result_.format == TrajectoryFormat::kEuroc)
            return "at least " + std::to_string(order_.count()) + " finite numbers, as the header line says";
        return "eight finite numbers: timestamp tx ty tz qx qy qz qw";
    }

    void take_matrix(const std::vector<double>& v) {
        Eigen::Matrix3d rotation;
        rotation << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
        // Files have six digits and more; much less is no rotation but something else in 12 columns.
        const double off =
            (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
        if (!(off < 0.02) || rotation.determinant() < 0) {
            fail("the first 3 x 3 numbers of the 3 x 4 matrix are no rotation");
        }
        const auto index = static_cast<std::int64_t>(result_.poses.size());
        check_position({v[3], v[7], v[11]});
        result_.poses.push_back(
            {index * kIndexStepUs, make_pose({v[3], v[7], v[11]}, Eigen::Quaterniond(rotation))});
    }

    void take_stamped(const std::vector<double>& v, const std::vector<std::string_view>& text) {
        const auto& [x, y, z, w] = order_.quaternion;
        const Eigen::Quaterniond q(v[w], v[x], v[y], v[z]);
        if (!(std::abs(q.norm() - 1) <= kLengthTolerance)) {
            fail("the quaternion is not of unit length: qx qy qz qw are " + short_number_text(q.norm()) +
                 " long, must be " + short_number_text(1 - kLengthTolerance) + " to " +
                 short_number_text(1 + kLengthTolerance));
        }
        const auto& [px, py, pz] = order_.position;
        check_position({v[px], v[py], v[pz]});
        result_.poses.push_back({utime_of(text[order_.timestamp]), make_pose({v[px], v[py], v[pz]}, q)});
    }

    void check_position(const Eigen::Vector3d& position) const {
        constexpr const char* kNames[] = {"tx", "ty", "tz"};
        for (int i = 0; i < 3; ++i) {
            if (std::abs(position[i]) <= kFarthest_m) continue;
            fail(std::string(kNames[i]) + " is " + short_number_text(position[i]) + " m, must be " +
                 short_number_text(-kFarthest_m) + " to " + short_number_text(kFarthest_m) + " m");
        }
    }

    /// Sorted poses that share their stamp with the one before.
    void note_repeated_stamps() {
        std::size_t same = 0, other = 0;
        for (std::size_t i = 1; i < result_.poses.size(); ++i) {
            const StampedPose &before = result_.poses[i - 1], &pose = result_.poses[i];
            if (before.utime != pose.utime) continue;
            ++(before.world_from_camera.matrix() == pose.world_from_camera.matrix() ? same : other);
        }
        if (same + other == 0) return;
        std::string what;
        if (same > 0) what = count_text(same, "pose stands", "poses stand") + " there twice";
        if (other > 0) {
            what += (same > 0 ? ", " : "") + count_text(other, "pose says", "poses say") +
                    " something else than another of the same stamp, of which the last is taken";
        }
        result_.notes.push_back(file_.string() + ": " + what);
    }

    std::int64_t utime_of(std::string_view text) {
        const bool scaled = header_ && header_->unit && text.find_first_of("eE") == std::string_view::npos;
        try {
            return stamps_.read(scaled ? in_seconds(text, *header_->unit) : std::string(text));
        } catch (const std::runtime_error& error) {
            fail(error.what());
        }
    }

    std::filesystem::path file_;
    int number_ = 0;  ///< of the line
    std::optional<Header> header_;
    std::size_t columns_ = 0;  ///< 0: no line of numbers was seen yet
    Columns order_ = kTum;
    StampColumn stamps_;
    TrajectoryFile result_;
};

}  // namespace

const char* format_name(TrajectoryFormat format) {
    switch (format) {
        case TrajectoryFormat::kTum:
            return "TUM";
        case TrajectoryFormat::kEuroc:
            return "EuRoC";
        case TrajectoryFormat::kKitti:
            return "KITTI";
    }
    return "?";
}

TrajectoryFile read_trajectory_file(const std::filesystem::path& file) {
    return Reader(file).read();
}

Trajectory read_trajectory(const std::filesystem::path& file, std::vector<std::string>* notes) {
    TrajectoryFile read = read_trajectory_file(file);
    if (read.format == TrajectoryFormat::kKitti) {
        throw std::runtime_error(file.string() +
                                 ": 12 numbers a line are KITTI's form, which has no timestamps; poses with "
                                 "timestamps are needed: TUM's or EuRoC's form");
    }
    if (notes != nullptr) notes->insert(notes->end(), read.notes.begin(), read.notes.end());
    return std::move(read.poses);
}

void require_poses(const std::filesystem::path& file, const Trajectory& trajectory) {
    if (trajectory.empty()) throw std::runtime_error(file.string() + ": holds no poses");
}

std::string span_text(const Trajectory& trajectory) {
    if (trajectory.empty()) return "nothing";
    return span_text(trajectory.front().utime, trajectory.back().utime);
}

std::string span_text(std::int64_t first_utime, std::int64_t last_utime) {
    char text[80];
    std::snprintf(text, sizeof(text), "%.3f to %.3f s", static_cast<double>(first_utime) * 1e-6,
                  static_cast<double>(last_utime) * 1e-6);
    return text;
}

}  // namespace planemap
