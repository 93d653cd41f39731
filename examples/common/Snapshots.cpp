// SPDX-License-Identifier: MIT
#include "Snapshots.h"

#include <osg/Math>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>
#include <osgViewer/Viewer>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>

namespace example {

namespace {

/// Supersampling factor: gives smooth edges on every driver.
constexpr unsigned int kFiner = 2;

/// Reads the picture back at the end of a draw, when the context is current.
struct ReadBack : osg::Camera::DrawCallback {
    osg::ref_ptr<osg::Image> image = new osg::Image;
    void operator()(osg::RenderInfo& info) const override {
        const osg::Viewport& viewport = *info.getCurrentCamera()->getViewport();
        image->readPixels(0, 0, static_cast<int>(viewport.width()),
                          static_cast<int>(viewport.height()), GL_RGB, GL_UNSIGNED_BYTE);
    }
};

/// Averages each block of kFiner x kFiner pixels.
osg::ref_ptr<osg::Image> averaged(const osg::Image& image) {
    osg::ref_ptr<osg::Image> result = new osg::Image;
    result->allocateImage(image.s() / int(kFiner), image.t() / int(kFiner), 1, GL_RGB,
                          GL_UNSIGNED_BYTE);
    const auto width = unsigned(result->s());
    const auto height = unsigned(result->t());
    for (unsigned int y = 0; y < height; ++y) {
        unsigned char* out = result->data(0, y);
        for (unsigned int x = 0; x < width; ++x, out += 3) {
            unsigned int sum[3] = {};
            for (unsigned int k = 0; k < kFiner * kFiner; ++k) {
                const unsigned char* in =
                    image.data(x * kFiner + k % kFiner, y * kFiner + k / kFiner);
                for (int c = 0; c < 3; ++c) sum[c] += in[c];
            }
            for (int c = 0; c < 3; ++c)
                out[c] = static_cast<unsigned char>(sum[c] / (kFiner * kFiner));
        }
    }
    return result;
}

} // namespace

struct Snapshots::Impl {
    osgViewer::Viewer viewer;
    osg::ref_ptr<ReadBack> readBack = new ReadBack;
};

Snapshots::Snapshots(osg::Node* scene, const View& view, int width, int height)
    : _impl(std::make_unique<Impl>()) {
    osgViewer::Viewer& viewer = _impl->viewer;
    viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
    const osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->readDISPLAY();
    traits->setUndefinedScreenDetailsToDefaultScreen();
    traits->width = width * int(kFiner);
    traits->height = height * int(kFiner);
    traits->pbuffer = true; // may be larger than the screen
    traits->doubleBuffer = false;
    osg::ref_ptr<osg::GraphicsContext> context =
        osg::GraphicsContext::createGraphicsContext(traits);
    if (!context) throw std::runtime_error("no picture can be drawn; is DISPLAY set?");
    osg::Camera& camera = *viewer.getCamera();
    camera.setGraphicsContext(context);
    camera.setViewport(0, 0, traits->width, traits->height);
    camera.setDrawBuffer(GL_FRONT);
    camera.setReadBuffer(GL_FRONT);
    camera.setClearColor(osg::Vec4(0.13f, 0.145f, 0.16f, 1.0f));
    camera.setProjectionMatrixAsPerspective(view.fieldOfView, double(width) / height, 0.1, 1000.0);
    camera.setViewMatrixAsLookAt(view.eye, view.centre, view.up);
    camera.setFinalDrawCallback(_impl->readBack);
    viewer.setSceneData(scene);
    viewer.realize();
}

Snapshots::~Snapshots() = default;

osg::ref_ptr<osg::Image> Snapshots::take(double time) {
    // Draws twice, so that changes made during the first frame are visible on every driver.
    _impl->viewer.frame(time);
    _impl->viewer.frame(time);
    return averaged(*_impl->readBack->image);
}

void Snapshots::write(double time, const std::string& file) {
    writePicture(*take(time), file);
}

void writePicture(const osg::Image& image, const std::string& file) {
    osgDB::makeDirectoryForFile(file);
    // OSG's image writers do not report a full disk, so encode first and then write the bytes.
    osgDB::ReaderWriter* const writer = osgDB::Registry::instance()->getReaderWriterForExtension(
        osgDB::getLowerCaseFileExtension(file));
    std::ostringstream encoded;
    if (writer == nullptr || !writer->writeImage(image, encoded, nullptr).success())
        throw std::runtime_error(file + ": not a picture format that can be written");
    std::ofstream out(file, std::ios::binary);
    out << encoded.str();
    out.close();
    if (out) return;
    if (std::filesystem::is_regular_file(file)) std::remove(file.c_str());
    throw std::runtime_error(file + ": cannot be written");
}

std::string pictureName(const std::string& folder, const std::string& prefix, unsigned int index) {
    char number[16];
    std::snprintf(number, sizeof number, "_%02u.png", index);
    return folder + "/" + prefix + number;
}

View framed(const osg::BoundingBoxd& box, const osg::Vec3d& side, double aspect) {
    View view;
    view.centre = box.center();
    osg::Vec3d back = side;
    back.normalize();
    osg::Vec3d right = view.up ^ back;
    right.normalize();
    const osg::Vec3d up = back ^ right;
    const double height = std::tan(0.5 * osg::DegreesToRadians(view.fieldOfView)) / 1.1;
    double distance = 0.0;
    for (unsigned int i = 0; i < 8; ++i) {
        const osg::Vec3d corner = box.corner(i) - view.centre;
        const double from = std::max(std::abs(corner * up), std::abs(corner * right) / aspect);
        distance = std::max(distance, from / height + corner * back);
    }
    view.eye = view.centre + back * distance;
    return view;
}

} // namespace example

namespace figures {

Tile tiled(const std::vector<Tile>& tiles, std::size_t columns) {
    const int width = tiles.front()->s();
    const int height = tiles.front()->t();
    const std::size_t rows = (tiles.size() + columns - 1) / columns;
    Tile sheet = new osg::Image;
    sheet->allocateImage(width * int(columns), height * int(rows), 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (std::size_t i = 0; i < tiles.size(); ++i)
        sheet->copySubImage(width * int(i % columns), height * int(rows - 1 - i / columns), 0,
                            tiles[i]); // images have their origin at the lower left
    return sheet;
}

Tile photograph(osg::Node* scene, const example::View& view, int width, int height) {
    return example::Snapshots(scene, view, width, height).take(0.0);
}

void writePicture(const osg::Image& image, const std::string& file) {
    example::writePicture(image, file);
    std::cout << file << std::endl;
}

} // namespace figures
