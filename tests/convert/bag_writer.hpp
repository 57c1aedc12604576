// SPDX-License-Identifier: BSD-3-Clause
// Writes small bags by rosbag itself; C++17, as its headers are.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace planemap {
namespace convert {

class BagWriter {
  public:
    /// `compression`: none, bz2 or lz4.
    explicit BagWriter(const std::string& file, const std::string& compression = "none");
    ~BagWriter();
    /// A message of any type by its bytes.
    void write(const std::string& topic, std::int64_t utime, const std::string& type,
               const std::vector<std::uint8_t>& bytes);
    void close();

  private:
    struct Rosbag;
    std::unique_ptr<Rosbag> rosbag_;
};

}  // namespace convert
}  // namespace planemap
