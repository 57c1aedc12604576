// SPDX-License-Identifier: BSD-3-Clause
#include "convert/bag_reader.hpp"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <exception>
#include <stdexcept>

namespace planemap {
namespace convert {

struct BagReader::Rosbag {
    rosbag::Bag bag;
    std::unique_ptr<rosbag::View> view;
    rosbag::View::iterator at;
};

namespace {

/// rosbag throws a dozen types of exceptions at what is damaged, those of boost and of the library among
/// them.
template <typename Work>
auto reading(const std::string& file, const Work& work) {
    try {
        return work();
    } catch (const rosbag::BagUnindexedException&) {
        throw std::runtime_error(
            file + ": the bag was not closed when it was recorded: `rosbag reindex` makes it whole");
    } catch (const std::exception& error) {
        throw std::runtime_error(file + ": cannot be read as a ROS 1 bag: " + error.what());
    }
}

}  // namespace

BagReader::BagReader(const std::string& file) : file_(file), rosbag_(new Rosbag) {
    reading(file_, [&] {
        rosbag_->bag.open(file_, rosbag::bagmode::Read);
        rosbag::View all(rosbag_->bag);
        for (const rosbag::ConnectionInfo* connection : all.getConnections())
            types_[connection->topic] = connection->datatype;
        return 0;
    });
}

BagReader::~BagReader() = default;

void BagReader::select(const std::vector<std::string>& topics) {
    reading(file_, [&] {
        rosbag_->view.reset(new rosbag::View(rosbag_->bag, rosbag::TopicQuery(topics)));
        rosbag_->at = rosbag_->view->begin();
        return 0;
    });
}

std::size_t BagReader::size() const {
    return reading(file_, [&] { return static_cast<std::size_t>(rosbag_->view->size()); });
}

bool BagReader::next(BagMessage& message) {
    return reading(file_, [&] {
        if (rosbag_->at == rosbag_->view->end()) return false;
        const rosbag::MessageInstance& instance = *rosbag_->at;
        message.topic = instance.getTopic();
        const ros::Time time = instance.getTime();
        message.utime = static_cast<std::int64_t>(time.sec) * 1000000 + time.nsec / 1000;
        message.bytes.resize(instance.size());
        ros::serialization::OStream stream(message.bytes.data(),
                                           static_cast<std::uint32_t>(message.bytes.size()));
        instance.write(stream);
        ++rosbag_->at;
        return true;
    });
}

}  // namespace convert
}  // namespace planemap
