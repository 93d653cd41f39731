// SPDX-License-Identifier: MIT
#include <osgSkinGpu/MappedUploads>

#include "skin/ComputeStage.h"

#include <osg/Array>
#include <osg/BufferObject>
#include <osg/ContextData>
#include <osg/GLExtensions>
#include <osg/GLObjects>
#include <osg/Geometry>
#include <osg/GraphicsContext>
#include <osg/NodeVisitor>
#include <osg/State>
#include <osg/StateSet>
#include <osg/ref_ptr>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <utility>
#include <vector>

#ifndef GL_COPY_READ_BUFFER
#define GL_COPY_READ_BUFFER 0x8F36
#define GL_COPY_WRITE_BUFFER 0x8F37
#endif
#ifndef GL_MAP_WRITE_BIT
#define GL_MAP_WRITE_BIT 0x0002
#endif
#ifndef GL_MAP_PERSISTENT_BIT
#define GL_MAP_PERSISTENT_BIT 0x0040
#define GL_MAP_COHERENT_BIT 0x0080
#endif
#ifndef GL_SYNC_GPU_COMMANDS_COMPLETE
#define GL_SYNC_GPU_COMMANDS_COMPLETE 0x9117
#define GL_ALREADY_SIGNALED 0x911A
#define GL_CONDITION_SATISFIED 0x911C
#endif

namespace osgSkin {
namespace {

using namespace osg; // GLsync, GLintptr and GLsizeiptr, where gl.h has none (Windows)

std::atomic<unsigned int>& mappedCount() {
    static std::atomic<unsigned int> count{0};
    return count;
}

std::atomic<unsigned int>& refusedCount() {
    static std::atomic<unsigned int> count{0};
    return count;
}

/// Of a geometry that a skin has deformed: it holds the deformed arrays alone, without gaps.
const osg::VertexBufferObject& bufferOf(const osg::Geometry& geometry) {
    return *geometry.getVertexArray()->getVertexBufferObject();
}

/// Mapped memory of a context, through which vertices go to its vertex buffers.
///
/// Threads that deform write to pages. The draw orders the copies from there, then a fence for each
/// page without other copies; when the card has passed it, the page is free again. So threads may
/// run ahead of the draw and of the card, and nobody counts frames.
class UploadPages {
public:
    /// Null for contexts beyond kMaxContexts.
    static UploadPages* of(unsigned int contextId) {
        // Never deleted: contexts may be gone when a process ends.
        static auto& all = *new std::array<UploadPages, kMaxContexts>;
        return contextId < kMaxContexts ? &all[contextId] : nullptr;
    }

    /// Copies a deformed geometry's arrays to a page, for the next draw; any thread.
    ///
    /// \return false where there is no room
    bool add(const osg::Geometry& geometry);

    /// In the context's draw: orders the copies, and makes room for those that had none.
    void fetch(osg::State& state);

    /// \param isCurrent whether the context is, so that its objects can be deleted
    void close(unsigned int contextId, bool isCurrent);

private:
    struct Page {
        GLuint buffer = 0;
        std::byte* memory = nullptr;
        std::size_t size = 0, used = 0;
        unsigned int pending = 0; ///< copies that are being written or wait for the draw
        GLsync fence = nullptr;
    };
    struct Copy {
        osg::ref_ptr<const osg::Geometry> geometry;
        unsigned int modified; ///< changes where OSG uploads the arrays later, as they then are
        Page* page;
        std::size_t offset, size;
    };
    using CopyFunction = void(GL_APIENTRY*)(GLenum from, GLenum to, GLintptr offset,
                                            GLintptr offsetTo, GLsizeiptr size);
    enum class Ability { Unknown, None, Mapping };

    static constexpr std::size_t kPageSize = std::size_t{4} << 20;
    static std::size_t roomFor(std::size_t size) { return (size + 63) / 64 * 64; }

    bool take(Copy& copy);
    void open(const osg::State& state);
    void order(const Copy& copy, osg::State& state) const;
    void reclaim(const osg::GLExtensions& gl);
    void addPages(const osg::GLExtensions& gl, std::size_t missing, std::size_t largest);

    std::shared_mutex _closing; ///< exclusively locked while pages go
    std::mutex _mutex;          ///< of what follows
    std::vector<std::unique_ptr<Page>> _pages;
    std::vector<Copy> _copies;
    std::size_t _missing = 0, _largest = 0; ///< bytes without room: in total, and of one copy
    std::atomic<Ability> _ability{Ability::Unknown};
    CopyFunction _copy = nullptr; ///< the draw's, as is the next
    std::vector<Copy> _fetched;   ///< empty but for its memory
};

/// Forgets a context's pages when it closes.
class ClosePages : public osg::GraphicsObjectManager {
public:
    explicit ClosePages(unsigned int contextId)
        : osg::GraphicsObjectManager("osgSkin uploads", contextId) {}
    void flushDeletedGLObjects(double, double&) override {}
    void flushAllDeletedGLObjects() override {}
    void deleteAllGLObjects() override { UploadPages::of(_contextID)->close(_contextID, true); }
    void discardAllGLObjects() override { UploadPages::of(_contextID)->close(_contextID, false); }
};

bool UploadPages::take(Copy& copy) {
    const std::lock_guard<std::mutex> lock(_mutex);
    const auto page = std::find_if(_pages.begin(), _pages.end(), [&](const auto& one) {
        return !one->fence && one->size - one->used >= copy.size;
    });
    if (page == _pages.end()) {
        _missing += roomFor(copy.size);
        _largest = std::max(_largest, roomFor(copy.size));
        return false;
    }
    copy.page = page->get();
    copy.offset = copy.page->used;
    copy.page->used = std::min(copy.page->size, copy.offset + roomFor(copy.size));
    ++copy.page->pending;
    return true;
}

bool UploadPages::add(const osg::Geometry& geometry) {
    const std::shared_lock<std::shared_mutex> notClosing(_closing);
    if (_ability != Ability::Mapping) return false;
    const osg::VertexBufferObject& buffer = bufferOf(geometry);
    Copy copy{&geometry, geometry.getVertexArray()->getModifiedCount(), nullptr, 0, 0};
    for (unsigned int i = 0; i < buffer.getNumBufferData(); ++i)
        copy.size += buffer.getBufferData(i)->getTotalDataSize();
    if (!take(copy)) return false;
    std::byte* to = copy.page->memory + copy.offset;
    for (unsigned int i = 0; i < buffer.getNumBufferData(); ++i) {
        const osg::BufferData& array = *buffer.getBufferData(i);
        std::memcpy(to, array.getDataPointer(), array.getTotalDataSize());
        to += array.getTotalDataSize();
    }
    const std::lock_guard<std::mutex> lock(_mutex);
    _copies.push_back(std::move(copy));
    return true;
}

void UploadPages::open(const osg::State& state) {
    const unsigned int id = state.getContextID();
    osg::get<ClosePages>(id);
    osg::setGLExtensionFuncPtr(_copy, "glCopyBufferSubData");
    const auto& gl = *state.get<osg::GLExtensions>();
    const auto has = [&](const char* extension, float version) {
        return osg::isGLExtensionOrVersionSupported(id, extension, version);
    };
    const bool canMap = has("GL_ARB_buffer_storage", 4.4f) && has("GL_ARB_copy_buffer", 3.1f) &&
                        has("GL_ARB_sync", 3.2f) && gl.glBufferStorage && gl.glMapBufferRange &&
                        gl.glFenceSync && gl.glClientWaitSync && gl.glDeleteSync && _copy;
    _ability = canMap ? Ability::Mapping : Ability::None;
}

void UploadPages::order(const Copy& copy, osg::State& state) const {
    osg::GLBufferObject* const to =
        bufferOf(*copy.geometry).getGLBufferObject(state.getContextID());
    // Else OSG uploads these arrays, or newer ones.
    if (!to || copy.geometry->getVertexArray()->getModifiedCount() != copy.modified) {
        ++refusedCount();
        return;
    }
    const auto& gl = *state.get<osg::GLExtensions>();
    if (to->isDirty()) { // now, since OSG would upload it over the copy
        state.unbindVertexBufferObject();
        to->compileBuffer();
        gl.glBindBuffer(GL_ARRAY_BUFFER_ARB, 0);
    }
    gl.glBindBuffer(GL_COPY_READ_BUFFER, copy.page->buffer);
    gl.glBindBuffer(GL_COPY_WRITE_BUFFER, to->getGLObjectID());
    _copy(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(copy.offset), 0,
          static_cast<GLsizeiptr>(copy.size));
    ++mappedCount();
}

void UploadPages::reclaim(const osg::GLExtensions& gl) {
    for (const std::unique_ptr<Page>& page : _pages) {
        if (page->fence) {
            const GLenum status = gl.glClientWaitSync(page->fence, 0, 0);
            if (status != GL_ALREADY_SIGNALED && status != GL_CONDITION_SATISFIED) continue;
            gl.glDeleteSync(page->fence);
            page->fence = nullptr;
            page->used = 0;
        } else if (page->used > 0 && page->pending == 0) {
            page->fence = gl.glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
        }
    }
}

void UploadPages::addPages(const osg::GLExtensions& gl, std::size_t missing, std::size_t largest) {
    const std::size_t size = std::max(kPageSize, largest);
    constexpr GLbitfield kFlags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    for (std::size_t made = 0; made < missing; made += size) {
        auto page = std::make_unique<Page>();
        page->size = size;
        gl.glGenBuffers(1, &page->buffer);
        gl.glBindBuffer(GL_COPY_READ_BUFFER, page->buffer);
        gl.glBufferStorage(GL_COPY_READ_BUFFER, static_cast<GLintptr>(size), nullptr, kFlags);
        page->memory = static_cast<std::byte*>(
            gl.glMapBufferRange(GL_COPY_READ_BUFFER, 0, static_cast<GLsizeiptr>(size), kFlags));
        if (!page->memory) {
            gl.glDeleteBuffers(1, &page->buffer);
            _ability = Ability::None; // until the context closes
            return;
        }
        _pages.push_back(std::move(page));
    }
}

void UploadPages::fetch(osg::State& state) {
    if (_ability == Ability::Unknown) open(state);
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _fetched.swap(_copies);
    }
    const auto& gl = *state.get<osg::GLExtensions>();
    for (const Copy& copy : _fetched) order(copy, state);
    const std::lock_guard<std::mutex> lock(_mutex);
    for (const Copy& copy : _fetched) --copy.page->pending;
    _fetched.clear();
    reclaim(gl);
    addPages(gl, std::exchange(_missing, 0), std::exchange(_largest, 0));
    if (_ability == Ability::None) return;
    gl.glBindBuffer(GL_COPY_READ_BUFFER, 0);
    gl.glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

void UploadPages::close(unsigned int contextId, bool isCurrent) {
    const std::unique_lock<std::shared_mutex> closing(_closing);
    const std::lock_guard<std::mutex> lock(_mutex);
    if (isCurrent && !_pages.empty()) {
        const osg::GLExtensions& gl = *osg::GLExtensions::Get(contextId, true);
        for (const std::unique_ptr<Page>& page : _pages) {
            if (page->fence) gl.glDeleteSync(page->fence);
            gl.glDeleteBuffers(1, &page->buffer);
        }
    }
    _pages.clear();
    _copies.clear();
    _missing = _largest = 0;
    _ability = Ability::Unknown;
}

/// Fetches the uploads of a context before a stage's other drawables: one leaf for all skins.
class FetchUploads : public osg::Drawable {
public:
    static FetchUploads& instance() {
        // Never deleted: contexts may be gone when a process ends.
        static const auto& fetch = *new osg::ref_ptr<FetchUploads>(new FetchUploads);
        return *fetch;
    }
    FetchUploads() : _place(new osg::StateSet) {
        setUseDisplayList(false);
        setSupportsDisplayList(false);
        setUpBin(*_place, kUploadBin);
    }

    /// Adds it to a cull's render stage, once; thread-safe.
    void addTo(osgUtil::CullVisitor& cv) {
        if (cv.getCurrentRenderBin()->getStage()->getRenderBinList().count(kUploadBin) == 0)
            addToStage(cv, *this, *_place);
    }

    osg::Object* cloneType() const override { return nullptr; }
    osg::Object* clone(const osg::CopyOp&) const override { return nullptr; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override {
        if (UploadPages* const pages = UploadPages::of(renderInfo.getContextID()))
            pages->fetch(*renderInfo.getState());
    }

private:
    osg::ref_ptr<osg::StateSet> _place;
};

/// The pages of the context that has a buffer, if it is the only one; else null.
UploadPages* pagesOf(const osg::BufferObject& buffer) {
    UploadPages* pages = nullptr;
    for (unsigned int id = 0; id <= osg::GraphicsContext::getMaxContextID(); ++id) {
        if (!buffer.getGLBufferObject(id)) continue;
        if (pages) return nullptr;
        pages = UploadPages::of(id);
        if (!pages) return nullptr;
    }
    return pages;
}

/// Lets the skin deform and draw itself, but not upload.
class UploadBackend : public DeformableSkin::DrawBackend {
public:
    osg::ref_ptr<DrawBackend> clone() const override { return new UploadBackend; }
    void skinChanged(const DeformableSkin&) override { FetchUploads::instance(); }
    void poseChanged(const DeformableSkin&) override {}
    osg::Geometry* cull(const DeformableSkin&, osgUtil::CullVisitor& cv) override {
        FetchUploads::instance().addTo(cv);
        _isCulled = true;
        return nullptr;
    }
    bool upload(const DeformableSkin& skin, const osg::Geometry& deformed) override {
        if (_isCulled && !skin.getEager() && !skin.getDrawCallback()) {
            UploadPages* const pages = pagesOf(bufferOf(deformed));
            if (pages && pages->add(deformed)) return true;
        }
        ++refusedCount();
        return false;
    }
    void compileGLObjects(osg::RenderInfo&) const override {}
    void resizeGLObjectBuffers(unsigned int) override {}
    void releaseGLObjects(osg::State*) const override {}

private:
    std::atomic<bool> _isCulled{false}; ///< so that a draw fetches
};

class SwitchUploads : public osg::NodeVisitor {
public:
    explicit SwitchUploads(bool on) : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), _on(on) {
        setNodeMaskOverride(~0u); // skins that are switched off may be switched on later
    }
    void apply(osg::Drawable& drawable) override {
        auto* skin = dynamic_cast<DeformableSkin*>(&drawable);
        if (!skin) return;
        setMappedUploads(*skin, _on);
        ++count;
    }

    unsigned int count = 0;

private:
    bool _on;
};

} // namespace

void setMappedUploads(DeformableSkin& skin, bool on) {
    const bool isOn = dynamic_cast<UploadBackend*>(skin.getDrawBackend()) != nullptr;
    if (on != isOn) skin.setDrawBackend(on ? new UploadBackend : nullptr);
}

unsigned int setMappedUploads(osg::Node& scene, bool on) {
    SwitchUploads visitor(on);
    scene.accept(visitor);
    return visitor.count;
}

UploadCounts uploadCounts() {
    return {mappedCount(), refusedCount()};
}

} // namespace osgSkin
