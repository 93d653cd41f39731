// SPDX-License-Identifier: MIT
#pragma once

#include "core/ContentHash.h"

#include <osg/observer_ptr>
#include <osg/ref_ptr>

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <unordered_map>

namespace osgSkin {

/// The living objects of a class by their content, so that equal ones from several loads can be one
/// object. Keeps none of them alive. Usable from any thread.
template <typename Object>
class SharedObjects {
public:
    /// The table of the process. It is never destroyed: objects may outlive any other static one.
    static SharedObjects& instance() {
        static auto* const table = new SharedObjects;
        return *table;
    }

    /// The living object of this content; null where there is none.
    osg::ref_ptr<Object> find(const ContentHash& content) {
        const std::lock_guard<std::mutex> lock(_mutex);
        return living(content);
    }

    /// Adds an object unless there is an equal one.
    ///
    /// \param isEqual called with a living object of the same hash; false: `added` replaces it
    /// \return the living object of this content: `added`, or the one that was there before
    template <typename IsEqual>
    osg::ref_ptr<Object> add(const ContentHash& content, const osg::ref_ptr<Object>& added,
                             const IsEqual& isEqual) {
        const std::lock_guard<std::mutex> lock(_mutex);
        const osg::ref_ptr<Object> known = living(content);
        if (known && isEqual(*known)) return known;
        if (_objects.size() >= _purgeAt) purge();
        _objects[content] = added.get();
        return added;
    }

private:
    struct Hash {
        std::size_t operator()(const ContentHash& content) const { return content.low; }
    };

    osg::ref_ptr<Object> living(const ContentHash& content) const {
        osg::ref_ptr<Object> object;
        const auto found = _objects.find(content);
        if (found != _objects.end()) found->second.lock(object);
        return object;
    }

    void purge() {
        for (auto it = _objects.begin(); it != _objects.end();)
            it = it->second.valid() ? std::next(it) : _objects.erase(it);
        _purgeAt = std::max<std::size_t>(64, 2 * _objects.size());
    }

    std::mutex _mutex;
    std::unordered_map<ContentHash, osg::observer_ptr<Object>, Hash> _objects;
    std::size_t _purgeAt = 64;
};

} // namespace osgSkin
