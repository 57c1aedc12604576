// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "core/acceleration.hpp"
#include "core/keyframe.hpp"
#include "core/look.hpp"
#include "core/plane_map.hpp"
#include "core/surfaces.hpp"
#include "map/map.hpp"
#include "map/map_losses.hpp"
#include "map/options.hpp"
#include "map/plane_ids.hpp"
#include "map/told_up.hpp"

namespace planemap::map {

/// A map of planes for each component of the trajectory: where one lies in another is not known, so no plane
/// of one meets one of the other. When a trajectory says that two hang together, their maps become one, and
/// planes keep their ids, which are unique over all maps.
class ComponentMaps {
  public:
    /// Throws std::invalid_argument for bad options.
    explicit ComponentMaps(const MapOptions& options);

    /// See PlaneMapper::start_from(): the map of the first component starts so.
    void start_from(const PlaneMap& map, const SeenSpace& seen = {});

    /// Takes a keyframe; it waits until a trajectory says where and of which component it is. Of more than
    /// 4096 that wait the oldest goes.
    void add(const Keyframe& keyframe);
    /// See PlaneMapper::add(const Look&). Returns whether a map changed by it.
    bool add(const Look& look);
    /// Takes new poses; see PlaneMapper::update().
    void update(const KeyframeTrajectory& trajectory);

    /// See PlaneMapper, of all maps.
    void hear_mount(const Pose& body_from_camera) { told_->hear_mount(body_from_camera); }
    void hear(const Acceleration& reading) { told_->hear(reading); }
    void restore_ids(const Surfaces& surfaces);
    void settle();

    /// The map of the component with the most keyframes.
    const PlaneMapper& largest() const { return *all().front(); }
    /// Those of all components that keyframes came of, in the order of components(); at least one.
    std::vector<const PlaneMapper*> all() const;

    Surfaces surfaces() const;
    std::size_t waiting() const { return waiting_.size(); }
    MapLosses losses() const;
    bool has_keyframe(int id) const;
    std::size_t keyframes() const;
    /// How often a map was rebuilt, over all.
    std::size_t rebuilds() const;
    std::size_t working_bytes() const;

  private:
    static constexpr int kNotNamed = -1;  ///< stands for the first component before a trajectory named it

    void wait(const Keyframe& keyframe);
    void join(const KeyframeTrajectory& trajectory);
    /// Made when the first keyframe comes: a trajectory may name what never does.
    PlaneMapper& map_of(int component);
    /// Of a keyframe that the last trajectory named.
    std::optional<int> component_of(int keyframe_id) const;

    MapOptions options_;
    PlaneIds ids_;
    std::shared_ptr<ToldUp> told_ = std::make_shared<ToldUp>();
    std::map<int, PlaneMapper> maps_;  ///< by component; at least one
    std::vector<int> order_;           ///< of the components that the last trajectory named
    KeyframeTrajectory last_;          ///< that one
    struct Waiting {
        Keyframe keyframe;  ///< without its features
        std::vector<Look> looks;
    };
    std::map<int, Waiting> waiting_;  ///< by id
    int newest_id_ = -1;              ///< the largest id of a keyframe so far
    MapLosses losses_;                ///< of those that wait
};

}  // namespace planemap::map
