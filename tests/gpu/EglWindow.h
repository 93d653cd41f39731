// SPDX-License-Identifier: MIT
#pragma once

#include <osgViewer/GraphicsWindow>

#include <memory>

namespace test {

/// A context of EGL's with a picture of its own: OSG's viewers draw in it without a display.
class EglWindow : public osgViewer::GraphicsWindow {
public:
    enum class Profile { Compatibility, Core };

    /// On Mesa's surfaceless platform, or else on the first EGL device; valid() tells whether that
    /// was possible.
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

    const char* libraryName() const override { return "osgSkin tests"; }
    const char* className() const override { return "EglWindow"; }
    bool isSameKindAs(const osg::Object* object) const override {
        return dynamic_cast<const EglWindow*>(object) != nullptr;
    }

protected:
    ~EglWindow() override;

private:
    struct Egl; // its headers define macros that OSG's and GoogleTest's do not expect
    std::unique_ptr<Egl> _egl;
    bool _isRealized = false;
};

} // namespace test
