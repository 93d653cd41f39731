// SPDX-License-Identifier: MIT
#pragma once

#include <osg/observer_ptr>
#include <osg/ref_ptr>

#include <map>
#include <mutex>

namespace osgSkin {

/// Packed data by source, shared by all who use it and freed with the last of them. Thread-safe.
///
/// \tparam Packed keeps its source alive, and calls forget() in its destructor
template <class Source, class Packed>
class PackedOnce {
public:
    /// \param make packs the source; called where nobody has what was packed before
    template <class Make>
    static osg::ref_ptr<Packed> find(const Source& source, const Make& make) {
        Known& all = known();
        const std::lock_guard<std::mutex> lock(all.mutex);
        osg::ref_ptr<Packed> found;
        osg::observer_ptr<Packed>& place = all.packed[&source];
        // A null entry may be of an earlier source at this address.
        if (!place.lock(found)) {
            found = make();
            place = found.get();
        }
        return found;
    }

    static void forget(const Source& source) {
        Known& all = known();
        const std::lock_guard<std::mutex> lock(all.mutex);
        const auto found = all.packed.find(&source);
        if (found != all.packed.end() && !found->second.valid()) all.packed.erase(found);
    }

private:
    struct Known {
        std::mutex mutex;
        std::map<const Source*, osg::observer_ptr<Packed>> packed;
    };
    /// Never destroyed: skins in an application's statics may outlive it.
    static Known& known() {
        static Known& instance = *new Known;
        return instance;
    }
};

} // namespace osgSkin
