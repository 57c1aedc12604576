// SPDX-License-Identifier: BSD-3-Clause
// The messages of a ROS 1 bag as bytes. rosbag's headers are C++17 at most, so this one and its source are,
// too, and all that knows what the bytes mean is elsewhere.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace planemap {
namespace convert {

struct BagMessage {
    std::string topic;
    std::int64_t utime = 0;  ///< of recording, microseconds
    std::vector<std::uint8_t> bytes;
};

class BagReader {
  public:
    /// Throws std::runtime_error naming file and reason.
    explicit BagReader(const std::string& file);
    ~BagReader();
    BagReader(const BagReader&) = delete;
    BagReader& operator=(const BagReader&) = delete;

    /// The type of each topic, as "sensor_msgs/Image".
    const std::map<std::string, std::string>& types() const { return types_; }

    /// Begins to read these topics, in the order of recording.
    void select(const std::vector<std::string>& topics);
    /// Messages of the selection.
    std::size_t size() const;
    /// The next message of the selection; false at its end. Throws std::runtime_error if it cannot be read.
    bool next(BagMessage& message);

  private:
    struct Rosbag;
    std::string file_;
    std::unique_ptr<Rosbag> rosbag_;
    std::map<std::string, std::string> types_;
};

}  // namespace convert
}  // namespace planemap
