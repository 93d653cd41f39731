// SPDX-License-Identifier: GPL-3.0-or-later
#include "MaterialLibrary.h"

#include "Bytes.h"
#include "ImageBytes.h"

#include <osgDB/FileNameUtils>

#include <filesystem>
#include <map>
#include <sstream>

namespace bake {
namespace {

/// Names images as the library at `file` has to, and writes those that are nowhere.
class Images {
public:
    Images(std::string file, std::string folder)
        : _file(std::move(file)), _folder(std::move(folder)) {}

    std::string nameOf(const osg::Image& image) {
        const auto [entry, isNew] = _names.emplace(&image, std::string());
        if (!isNew) return entry->second;
        const std::optional<ImageBytes> bytes = bytesOf(image, _folder);
        if (!bytes) return entry->second;
        if (!bytes->file.empty()) {
            // Without links: a name that leads upward goes by where folders are.
            const auto file = std::filesystem::weakly_canonical(bytes->file);
            const auto here = std::filesystem::weakly_canonical(_file).parent_path();
            return entry->second = file.lexically_proximate(here).string();
        }
        const std::string name = osgDB::getNameLessExtension(_file) + "_" +
                                 std::to_string(++_written) + (bytes->isJpeg ? ".jpg" : ".png");
        writeBytes(name, bytes->data);
        return entry->second = osgDB::getSimpleFileName(name);
    }

private:
    std::string _file, _folder;
    std::map<const osg::Image*, std::string> _names;
    int _written = 0;
};

std::ostream& operator<<(std::ostream& out, const osg::Vec4& c) {
    return out << c.r() << ' ' << c.g() << ' ' << c.b();
}

} // namespace

std::string libraryName(const std::string& pattern) {
    std::string stem = osgDB::getStrippedName(pattern);
    const std::size_t percent = stem.find('%');
    if (percent != std::string::npos) {
        stem = stem.substr(0, percent) + stem.substr(stem.find('d', percent) + 1);
        while (!stem.empty() && std::string("_-. ").find(stem.back()) != std::string::npos)
            stem.pop_back();
        if (stem.empty()) stem = "frame";
    }
    return stem + ".mtl";
}

std::string materialName(std::size_t surface) {
    return "skin_" + std::to_string(surface + 1);
}

void writeLibrary(const std::string& file, const std::vector<Surface>& surfaces,
                  const std::string& folder) {
    Images images(file, folder);
    std::ostringstream out;
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
        const SurfaceMaterial material = SurfaceMaterial::of(surfaces[s]);
        out << "newmtl " << materialName(s) << "\nKd " << material.diffuse << "\nKs "
            << material.specular << "\nKe " << material.emission << "\nNs " << material.shininess
            << "\nd "
            << (material.alpha == SurfaceMaterial::Alpha::Opaque ? 1.0f : material.diffuse.a())
            << "\nillum 2\n";
        if (!material.image) continue;
        const std::string name = images.nameOf(*material.image);
        if (!name.empty()) out << "map_Kd " << name << "\n";
    }
    writeBytes(file, out.str());
}

} // namespace bake
