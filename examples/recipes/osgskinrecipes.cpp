// SPDX-License-Identifier: MIT
#include "CommandLine.h"
#include "DataFolder.h"
#include "Recipes.h"
#include "Samples.h"
#include "WindowOptions.h"

#include <osgSkin/Error>

#include <osgGA/TrackballManipulator>
#include <osgViewer/Viewer>
#include <osgViewer/ViewerEventHandlers>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <stdexcept>

namespace {

int show(const Stage& stage, osgViewer::Viewer& viewer, const example::WindowOptions& window) {
    viewer.setSceneData(stage.scene);
    viewer.addEventHandler(new osgViewer::StatsHandler);
    const osg::ref_ptr<osgGA::TrackballManipulator> camera = new osgGA::TrackballManipulator;
    camera->setHomePosition(stage.view.eye, stage.view.centre, stage.view.up);
    viewer.setCameraManipulator(camera);
    window.open(viewer);
    return viewer.run();
}

/// \return the exit status: 1 where a recipe cannot show the character, which stderr says
int takePictures(const std::vector<Recipe>& chosen, const std::string& character,
                 const std::string& samples, const std::string& folder) {
    int status = 0;
    for (const Recipe& recipe : chosen) try {
            const std::string file = folder + "/" + recipe.name + ".png";
            example::writePicture(*pictureOf(recipe, character, samples), file);
            std::cout << file << std::endl;
        } catch (const std::exception& error) {
            std::cerr << recipe.name << ": " << osgSkin::onOneLine(error.what()) << std::endl;
            status = 1;
        }
    return status;
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
    example::CommandLine line("osgskinrecipes", "Shows a recipe: a short program for a usual task.",
                              example::kWindowHelp);
    std::string name, file, out, data = example::dataFolder();
    bool list = false;
    std::string samples =
        (std::filesystem::temp_directory_path() / "osgskin-recipes").generic_string();
    line.add("RECIPE", name, "the recipe; all with --out if none is named");
    line.add("CHARACTER", file,
             std::string(example::kCharacterHelp) + ", in place of the recipe's own");
    line.add("--list", list, "list the recipes");
    line.add("--out", out, "write pictures to this folder instead of opening a window");
    line.add("--characters", samples, "folder for the characters that recipes show").showDefault();
    line.add("--data", data, "folder of the thrower, of whom they are made");
    return line.run(argc, argv, [&] {
        osg::ArgumentParser words(&argc, argv);
        const example::WindowOptions window(words, 960, 720);
        osgViewer::Viewer viewer(words);
        line.parse(argc, argv);
        const std::vector<Recipe> chosen = choose(name);
        if (list || (name.empty() && out.empty())) {
            for (const Recipe& recipe : chosen) std::cout << recipe.name << '\n';
            return 0;
        }
        if (file.empty()) writeSamples(data, samples);
        if (out.empty()) return show(stageOf(chosen.front(), file, samples), viewer, window);
        return takePictures(chosen, file, samples, out);
    });
}
