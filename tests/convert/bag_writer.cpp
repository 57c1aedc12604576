// SPDX-License-Identifier: BSD-3-Clause
#include "convert/bag_writer.hpp"

#include <rosbag/bag.h>

#include <cstring>

namespace planemap {
namespace convert {
struct AnyMessage {
    std::string type;
    std::vector<std::uint8_t> bytes;
};
}  // namespace convert
}  // namespace planemap

namespace ros {
namespace message_traits {
template <>
struct MD5Sum<planemap::convert::AnyMessage> {
    static const char* value(const planemap::convert::AnyMessage&) {
        return "0123456789abcdef0123456789abcdef";
    }
    static const char* value() { return "0123456789abcdef0123456789abcdef"; }
};
template <>
struct DataType<planemap::convert::AnyMessage> {
    static const char* value(const planemap::convert::AnyMessage& m) { return m.type.c_str(); }
    static const char* value() { return "*"; }
};
template <>
struct Definition<planemap::convert::AnyMessage> {
    static const char* value(const planemap::convert::AnyMessage&) { return ""; }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<planemap::convert::AnyMessage> {
    template <typename Stream>
    static void write(Stream& stream, const planemap::convert::AnyMessage& m) {
        std::memcpy(stream.advance(static_cast<std::uint32_t>(m.bytes.size())), m.bytes.data(),
                    m.bytes.size());
    }
    static std::uint32_t serializedLength(const planemap::convert::AnyMessage& m) {
        return static_cast<std::uint32_t>(m.bytes.size());
    }
};
}  // namespace serialization
}  // namespace ros

namespace planemap {
namespace convert {

struct BagWriter::Rosbag {
    rosbag::Bag bag;
};

BagWriter::BagWriter(const std::string& file, const std::string& compression) : rosbag_(new Rosbag) {
    rosbag_->bag.open(file, rosbag::bagmode::Write);
    rosbag_->bag.setChunkThreshold(10000);  // several chunks in a small bag
    if (compression == "bz2") rosbag_->bag.setCompression(rosbag::compression::BZ2);
    if (compression == "lz4") rosbag_->bag.setCompression(rosbag::compression::LZ4);
}

BagWriter::~BagWriter() = default;

void BagWriter::write(const std::string& topic, std::int64_t utime, const std::string& type,
                      const std::vector<std::uint8_t>& bytes) {
    const ros::Time time(static_cast<std::uint32_t>(utime / 1000000),
                         static_cast<std::uint32_t>(utime % 1000000) * 1000);
    rosbag_->bag.write(topic, time, AnyMessage{type, bytes});
}

void BagWriter::close() {
    rosbag_->bag.close();
}

}  // namespace convert
}  // namespace planemap
