// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_ORDEREDALLOCATOR_H
#define OSGSKINBIND_FIT_ORDEREDALLOCATOR_H

#include <cstddef>
#include <memory>
#include <memory_resource>
#include <new>

namespace osgSkin::fit {

/// Memory whose addresses grow with every allocation; freed all at once.
///
/// CGAL's mean curvature flow keeps edges in sets ordered by address, so with the usual allocator
/// the same body gives another skeleton in every process.
class OrderedMemory {
public:
    OrderedMemory() : _buffer(new std::byte[kBytes]), _resource(_buffer.get(), kBytes) {
        current() = &_resource;
    }
    ~OrderedMemory() { current() = nullptr; }
    OrderedMemory(const OrderedMemory&) = delete;
    OrderedMemory& operator=(const OrderedMemory&) = delete;

    /// The one in use in this thread; null outside its lifetime.
    static std::pmr::monotonic_buffer_resource*& current() {
        thread_local std::pmr::monotonic_buffer_resource* memory = nullptr;
        return memory;
    }

private:
    /// Pages that are not used are not taken from the system. More than this is in order only
    /// within each further block.
    static constexpr std::size_t kBytes = std::size_t(64) << 20;

    std::unique_ptr<std::byte[]> _buffer;
    std::pmr::monotonic_buffer_resource _resource;
};

/// Takes from OrderedMemory while there is one.
///
/// Everything so allocated has to die before the memory does.
template <typename T>
struct OrderedAllocator {
    using value_type = T;
    template <typename U>
    struct rebind {
        using other = OrderedAllocator<U>;
    };

    OrderedAllocator() = default;
    template <typename U>
    OrderedAllocator(const OrderedAllocator<U>&) {}

    T* allocate(std::size_t n) {
        if (auto* memory = OrderedMemory::current())
            return static_cast<T*>(memory->allocate(n * sizeof(T), alignof(T)));
        return static_cast<T*>(::operator new(n * sizeof(T)));
    }
    void deallocate(T* p, std::size_t) {
        if (!OrderedMemory::current()) ::operator delete(p);
    }

    bool operator==(const OrderedAllocator&) const { return true; }
    bool operator!=(const OrderedAllocator&) const { return false; }
};

} // namespace osgSkin::fit

#endif
