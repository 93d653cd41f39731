// SPDX-License-Identifier: MIT
#include "CommandLine.h"
#include "DataFolder.h"
#include "Recipes.h"
#include "Samples.h"

#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>

namespace {

int show(const Recipe& recipe, const std::string& file) {
    osgViewer::Viewer viewer;
    viewer.setUpViewInWindow(100, 100, 960, 720);
    viewer.setSceneData(onStage(recipe, file));
    viewer.addEventHandler(new osgViewer::StatsHandler);
    const example::View view = viewOf(recipe);
    const osg::ref_ptr<osgGA::TrackballManipulator> camera = new osgGA::TrackballManipulator;
    camera->setHomePosition(view.eye, view.centre, view.up);
    viewer.setCameraManipulator(camera);
    example::openWindow(viewer);
    return viewer.run();
}

void takePictures(const std::vector<Recipe>& chosen, const std::string& samples,
                  const std::string& folder) {
    for (const Recipe& recipe : chosen) {
        const std::string file = folder + "/" + recipe.name + ".png";
        example::writePicture(*pictureOf(recipe, samples), file);
        std::cout << file << std::endl;
    }
}

std::vector<Recipe> choose(const std::string& name) {
    std::vector<Recipe> chosen;
    std::string names;
    for (const Recipe& recipe : recipes()) {
        if (name.empty() || name == recipe.name) chosen.push_back(recipe);
        names += names.empty() ? recipe.name : std::string(", ") + recipe.name;
    }
    if (chosen.empty())
        throw std::runtime_error("no recipe is called \"" + name + "\"; expected one of " + names);
    return chosen;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Shows a recipe: a short program for a usual task.", "osgskinrecipes");
    app.set_version_flag("--version", example::versionText("osgskinrecipes"));
    std::string name, file, pictures, data = example::dataFolder();
    bool list = false;
    std::string samples =
        (std::filesystem::temp_directory_path() / "osgskin-recipes").generic_string();
    app.add_option("recipe", name, "the recipe; all with --pictures if none is named");
    app.add_option("file", file, "a character to show in place of the recipe's own");
    app.add_flag("--list", list, "list the recipes");
    app.add_option("--pictures", pictures, "write pictures to this folder; no window to look at");
    app.add_option("--samples", samples, "folder for the characters that recipes show")
        ->capture_default_str();
    app.add_option("--data", data, "folder of the thrower, of whom they are made");
    if (!example::hasNoEmptyWord("osgskinrecipes", argc, argv)) return 2;
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        const std::vector<Recipe> chosen = choose(name);
        if (list || (name.empty() && pictures.empty())) {
            for (const Recipe& recipe : chosen) std::cout << recipe.name << '\n';
            return example::finish("osgskinrecipes", 0);
        }
        if (file.empty() || !pictures.empty()) writeSamples(data, samples);
        if (pictures.empty())
            return show(chosen.front(),
                        file.empty() ? samples + "/" + chosen.front().sample : file);
        takePictures(chosen, samples, pictures);
        return example::finish("osgskinrecipes", 0);
    } catch (const std::exception& error) {
        std::cerr << "osgskinrecipes: " << error.what() << std::endl;
        return 1;
    }
}
