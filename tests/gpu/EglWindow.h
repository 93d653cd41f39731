// SPDX-License-Identifier: MIT
#pragma once

#include <osgViewer/GraphicsWindow>

#include <memory>

namespace test {

/// An EGL context with an off-screen surface: OSG's viewers draw in it without a display.
class EglWindow : public osgViewer::GraphicsWindow {
public:
    enum class Profile { Compatibility, Core };

    /// Uses Mesa's surfaceless platform, or else the first EGL device; valid() is false if neither
    /// works.
    EglWindow(int width, int height, Profile profile = Profile::Compatibility);

    bool valid() const override;
    bool realizeImplementation() override;
    bool isRealizedImplementation() const override { return _isRealized; }
    void closeImplementation() override;
    bool makeCurrentImplementation() override;
    bool makeContextCurrentImplementation(osg::GraphicsContext*) override {
        return makeCurrentImplementation();
    }
    bool releaseContextImplementation() override;
    void bindPBufferToTextureImplementation(GLenum) override {}
    void swapBuffersImplementation() override;
    void grabFocusIfPointerInWindow() override {}

    const char* libraryName() const override { return "osgSkin tests"; }
    const char* className() const override { return "EglWindow"; }
    bool isSameKindAs(const osg::Object* object) const override {
        return dynamic_cast<const EglWindow*>(object) != nullptr;
    }

protected:
    ~EglWindow() override;

private:
    struct Egl; // its headers define macros that conflict with OSG and GoogleTest
    std::unique_ptr<Egl> _egl;
    bool _isRealized = false;
};

} // namespace test
