// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAVEDINPUT_H
#define OSGSKINIMPORT_SAVEDINPUT_H 1

#include "saved/SavedImage.h"
#include "saved/SavedStream.h"

#include <osgSkinImport/ReadLimits>

#include <osgDB/StreamOperator>

#include <cstddef>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osgSkin {

/// What osgDB::InputStream reads a saved file from: the same layouts as OSG's own iterators, but
/// OSG believes what it reads, so it is checked here, where what is checked is what is read.
///
/// What is refused is thrown through OSG, which would go on with what is not there.
///
/// A list's length is a whole number before a bracket, or in a class with vectors. All lists
/// together have no more elements than the file has bytes.
class SavedInput : public osgDB::InputIterator {
public:
    /// \param content of the whole file
    /// \param pictures that those within it count together with; null: with none
    SavedInput(std::string content, const ReadLimits& limits, SharedPictures* pictures);

    /// \throw osgSkin::Error without the file's name
    [[noreturn]] static void refuse(const std::string& reason);

    /// Refuses what is left after the scene, where that means that some of it was not understood.
    virtual void finish() {}
    void advanceToCurrentEndBracket() override { begin(); }

protected:
    /// For each thing that is read, before it is. A serializer that refused what came before has
    /// left nothing where OSG goes on as if something were there.
    void begin();
    /// Refuses where OSG reads next: now it would lose what it has made room for.
    void refuseNext(std::string reason) { _refusal = std::move(reason); }
    std::string_view rest() const { return std::string_view(_content).substr(_at); }
    std::size_t remaining() const { return _content.size() - _at; }

    // What was read, to be checked. \return what OSG is to see of it
    int took(int number);
    unsigned took(unsigned number);
    /// What was read of a table, by its number: OSG goes on without an array of a kind that it does
    /// not know, and some take it for one.
    int tookMapped(const std::string& table, int value) const;
    void tookProperty(const std::string& name);
    void tookBegin();
    void tookMatch(const std::string& name) { _property = name; }
    std::string took(std::string word);
    std::string tookWrapped(std::string text);

    const std::string _content;
    std::size_t _at = 0;
    SavedImage _image;
    std::string _refusal; ///< see refuseNext(); empty: none

private:
    enum class Lists { None, Some, Itself };
    /// An object whose fields are being read.
    struct Open {
        std::size_t depth;
        unsigned id;
        bool sized = false; ///< its first list's length was read
        unsigned sets = 0;  ///< primitive sets that are still to come, of a geometry
    };

    SavedStream& stream() const;
    void dropClosed();
    void tookIdentifier(unsigned id);
    void checkClass();
    void checkSet(const osg::Object* known);
    void claim(std::uint64_t elements);
    Lists listsOf(const std::string& className);

    const ReadLimits& _limits;
    std::istringstream _none; ///< osgDB asks a stream for its state
    std::string _word, _property;
    std::vector<Open> _open;
    std::map<std::string, Lists> _lists;
    std::uint64_t _claimed = 0;
    std::int64_t _number = 0;
    bool _numberIsLast = false, _isSet = false;
};

} // namespace osgSkin

#endif
