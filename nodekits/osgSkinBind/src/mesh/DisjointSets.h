// SPDX-License-Identifier: MIT
#ifndef OSGSKINBIND_MESH_DISJOINTSETS_H
#define OSGSKINBIND_MESH_DISJOINTSETS_H

#include <cstddef>
#include <numeric>
#include <vector>

namespace osgSkin {

/// Union-find over the elements 0 to count - 1, each of which is in a set of its own at first.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : _above(count) {
        std::iota(_above.begin(), _above.end(), std::size_t(0));
    }

    /// The representative of the set that contains `element`.
    std::size_t find(std::size_t element) {
        while (_above[element] != element) {
            _above[element] = _above[_above[element]]; // halves the path for the next time
            element = _above[element];
        }
        return element;
    }

    void join(std::size_t a, std::size_t b) { _above[find(a)] = find(b); }

private:
    std::vector<std::size_t> _above;
};

} // namespace osgSkin

#endif
