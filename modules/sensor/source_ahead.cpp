// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/source_ahead.hpp"

#include <utility>

namespace planemap::sensor {

std::size_t frames_ahead(int threads, bool is_live) {
    return is_live ? 1 : static_cast<std::size_t>(threads) + 1;
}

SourceAhead::SourceAhead(std::unique_ptr<FrameSource> source, int threads, Prepare prepare)
    : source_(std::move(source)),
      size_(source_->size()),
      notes_(source_->notes()),
      progress_(source_->progress()),
      ahead_(std::make_unique<WorkAhead<Item>>(
          threads, frames_ahead(threads, source_->is_live()),
          WorkAhead<Item>::Work{[this](Item& item) { return read(item); },
                                [prepare = std::move(prepare)](Item& item, int worker) {
                                    if (item.result.status == ReadResult::Status::kFrame)
                                        item.prepared = prepare(item.frame, worker);
                                }})) {}

bool SourceAhead::read(Item& item) {
    const messages::SpentTimer timer(item.spent);
    item.result = source_->next(item.frame);
    item.progress = source_->progress();
    return item.result.status != ReadResult::Status::kEnd;
}

const SourceAhead::Item& SourceAhead::fetch() {
    if (!fetched_) fetched_ = ahead_->take();
    if (!fetched_) fetched_.emplace();  // after the end there is nothing but the end
    return *fetched_;
}

ReadResult SourceAhead::next(SensorFrame& frame) {
    fetch();
    Item item = *std::exchange(fetched_, std::nullopt);
    progress_ = item.progress;
    frame = std::move(item.frame);
    return std::move(item.result);
}

std::vector<std::string> SourceAhead::complaints() const {
    ahead_->stop();
    return source_->complaints();
}

std::string SourceAhead::end() {
    ahead_->stop();
    return source_->end();
}

}  // namespace planemap::sensor
