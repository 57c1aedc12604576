// SPDX-License-Identifier: BSD-3-Clause
// ROS 1 bags, format 2.0, read by our own bounded reader: ROS's library trusts every length in a file, needs
// the index at its end, and brings GPGME, Boost and a plug-in loader.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "messages/file_bytes.hpp"

namespace planemap::convert {

struct BagMessage {
    std::string topic;
    std::int64_t utime = 0;  ///< of recording, microseconds
    std::vector<std::uint8_t> bytes;
};

/// Reads the messages of a bag in the order of their recording times. A bag that was not closed, or is cut
/// short, gives what is whole. Chunks may be compressed by bz2 or lz4. Never takes more memory than a small
/// multiple of what is there.
class BagReader {
  public:
    /// Throws std::runtime_error naming file and reason if it is no such bag, encrypted, or cannot be read.
    explicit BagReader(const std::filesystem::path& file);

    /// The type of each topic, as "sensor_msgs/Image".
    const std::map<std::string, std::string>& types() const { return types_; }
    /// What is damaged, a line each: all is well if empty. Grows with what is read.
    std::vector<std::string> complaints() const;

    /// Begins to read these topics.
    void select(const std::vector<std::string>& topics);
    /// Messages of the selection.
    std::size_t size() const { return selected_.size(); }
    /// The next message of the selection that can be read; false at its end. Throws std::runtime_error if
    /// the file cannot be read.
    bool next(BagMessage& message);

  private:
    struct Chunk {
        std::uint64_t at = 0;                ///< of its data in the file
        std::uint32_t stored = 0, size = 0;  ///< bytes in the file, and decompressed
        std::string compression;
        bool indexed = false;
    };
    struct Entry {
        std::int64_t time_ns = 0;
        std::uint32_t connection = 0, chunk = 0, offset = 0;
    };
    struct Record;

    void scan();
    void scan_record(const Record& record);
    void scan_index(const Record& record);
    void scan_chunk(std::uint32_t chunk);
    void add_connection(const Record& record, std::span<const std::uint8_t> data);
    const std::vector<std::uint8_t>& chunk_bytes(std::uint32_t chunk);
    bool read(const Entry& entry, BagMessage& message);

    messages::FileBytes file_;
    std::vector<Chunk> chunks_;
    std::vector<Entry> entries_;
    std::map<std::uint32_t, std::string> topics_;  ///< by connection
    std::map<std::string, std::string> types_;     ///< by topic
    std::vector<std::size_t> selected_;            ///< entries
    std::size_t next_ = 0;
    std::uint32_t cached_chunk_ = 0;
    std::vector<std::uint8_t> cached_;
    bool is_cached_ = false;
    std::uint64_t whole_until_ = 0;  ///< where the first record begins that is not whole
    std::int64_t unreadable_ = 0;    ///< messages
    std::string fault_;              ///< of the first of them
};

}  // namespace planemap::convert
