// SPDX-License-Identifier: MIT
// A format is described once: a function template passes an object's members to an archive, which
// writes or reads them as a block of 32-bit words.
#pragma once

#include "BlockRows.h"
#include "serialize/BlockWords.h"

#include <osg/Matrixd>
#include <osg/Quat>
#include <osg/Vec3d>
#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <exception>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// The base of both archives. Numbers of more than 32 bits are two words.
template <typename Self>
class Archive {
public:
    template <typename... Values>
    void operator()(Values&... values) {
        (self().pass(values), ...);
    }

    /// Passes a number of items and each of them.
    /// \param name of the items, for errors
    /// \param words of the smallest item
    template <typename Items, typename Each>
    void list(Items& items, const char* name, std::size_t words, const Each& each) {
        self().count(items, name, words);
        for (auto& item : items) each(item);
    }

    template <typename Kind>
    void choice(Kind& kind, std::uint32_t count, const char* name) {
        auto number = static_cast<std::uint32_t>(kind);
        self().pass(number);
        if (number >= count) self().fail(std::string(name) + " is of no known kind");
        kind = static_cast<Kind>(number);
    }

protected:
    void pass(bool& value) {
        std::uint32_t word = value ? 1 : 0;
        self().pass(word);
        value = word != 0;
    }
    void pass(int& value) {
        auto word = static_cast<std::uint32_t>(value);
        self().pass(word);
        value = static_cast<int>(word);
    }
    void pass(std::size_t& value) {
        auto word = static_cast<std::uint32_t>(value);
        self().pass(word);
        value = word;
    }
    void pass(glm::dvec3& v) { (*this)(v.x, v.y, v.z); }
    void pass(glm::dquat& q) { (*this)(q.w, q.x, q.y, q.z); }
    void pass(osg::Vec3d& v) { (*this)(v.x(), v.y(), v.z()); }
    void pass(osg::Quat& q) { (*this)(q.x(), q.y(), q.z(), q.w()); }
    void pass(osg::Matrixd& m) {
        for (int i = 0; i < 16; ++i) (*this)(m.ptr()[i]);
    }

private:
    Self& self() { return static_cast<Self&>(*this); }
};

class WriteArchive : public Archive<WriteArchive> {
public:
    static constexpr bool kReads = false;
    osgSkin::BlockWriter out;

    using Archive::pass;
    void pass(std::uint32_t& value) { out.put(value); }
    void pass(float& value) { out.put(value); }
    void pass(double& value) { out.put(value); }
    void pass(std::string& value) { out.put(value); }
    template <typename Items>
    void count(const Items& items, const char*, std::size_t) {
        out.put(items.size());
    }
    void fail(const std::string&) {}
};

class ReadArchive : public Archive<ReadArchive> {
public:
    static constexpr bool kReads = true;
    osgSkin::BlockReader in;

    ReadArchive(const std::vector<std::uint32_t>& words, const char* name) : in(words, name) {}

    using Archive::pass;
    void pass(std::uint32_t& value) { value = in.word(); }
    void pass(float& value) { value = in.real(); }
    void pass(double& value) { value = in.longReal(); }
    void pass(std::string& value) { value = in.text(); }
    template <typename Items>
    void count(Items& items, const char* name, std::size_t words) {
        items.resize(in.count(name, words));
    }
    [[noreturn]] void fail(const std::string& what) { in.fail(what); }
};

/// Writes and reads a property that `Format::pass(archive, object)` describes.
template <typename Object, typename Format>
class BlockSerializer : public osgDB::BaseSerializer {
public:
    /// \param name of the property, and in lower case of the block, for errors
    BlockSerializer(const char* name, const char* block)
        : BaseSerializer(READ_WRITE_PROPERTY), _name(name), _block(block) {}

    const std::string& getName() const override { return _name; }

    bool write(osgDB::OutputStream& os, const osg::Object& object) override {
        WriteArchive archive;
        // Nothing is written to the object: passing it serves reading, too.
        Format::pass(archive, const_cast<Object&>(dynamic_cast<const Object&>(object)));
        if (!os.isBinary()) os << os.PROPERTY(_name.c_str());
        writeWords(os, archive.out.words);
        return true;
    }

    bool read(osgDB::InputStream& is, osg::Object& object) override {
        if (!is.isBinary() && !is.matchString(_name)) return true;
        std::vector<std::uint32_t> words;
        if (!readWords(is, words)) return false;
        try {
            ReadArchive archive(words, _block);
            Format::pass(archive, dynamic_cast<Object&>(object));
            if (!archive.in.atEnd()) archive.in.fail("it goes on after its end");
        } catch (const std::exception& error) {
            is.throwException(std::string("osgSkin: ") + error.what()); // refuses the whole file
        }
        return !is.getException();
    }

private:
    const std::string _name;
    const char* const _block;
};

template <typename Object, typename Format>
void addBlock(osgDB::ObjectWrapper& wrapper, const char* name, const char* block) {
    wrapper.addSerializer(new BlockSerializer<Object, Format>(name, block),
                          osgDB::BaseSerializer::RW_USER);
}
