// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

#include <osg/Program>

/// A figure of brushed metal: a program of your own, with tangents that the skin deforms.
osg::ref_ptr<osg::Node> ownShader(const std::string& file) {
    const int kTangent = 6; // vertex attribute; loaded models with normal maps have it already
    osgSkin::LoadOptions options;
    options.mergeRigid = true; // head, hands and feet as skins
    const osgSkin::Character character = osgSkin::loadCharacter(file, options);
    for (const osgSkin::AttachedSkin::Skin& each : character.skin.skins) {
        osgSkin::DeformableSkin& skin = *each.drawable;
        const osg::ref_ptr<osg::Geometry> rest = osg::clone(skin.getRestGeometry());
        const osg::ref_ptr<osg::Vec4Array> tangents = new osg::Vec4Array;
        for (osg::Vec3 normal : static_cast<osg::Vec3Array&>(*rest->getNormalArray())) {
            normal = osg::Vec3(0, 1, 0) ^ normal; // brushed around the vertical
            tangents->push_back(osg::Vec4(normal / (normal.length() + 1e-6f), 1.0f));
        }
        rest->setVertexAttribArray(kTangent, tangents, osg::Array::BIND_PER_VERTEX);
        skin.setSkin(rest, skin.getModel());
        skin.setTangentAttribute(kTangent);
    }
    const osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addBindAttribLocation("tangent", kTangent);
    program->addShader(new osg::Shader(osg::Shader::VERTEX, R"(#version 120
        attribute vec4 tangent; varying vec3 t, h;
        void main() { vec3 eye = -normalize((gl_ModelViewMatrix * gl_Vertex).xyz);
          t = gl_NormalMatrix * tangent.xyz;  h = eye + normalize(vec3(-0.3, 0.6, 0.6));
          gl_Position = gl_ModelViewProjectionMatrix * gl_Vertex; })"));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT, R"(#version 120
        varying vec3 t, h;
        void main() { float s = dot(normalize(t), normalize(h));
          gl_FragColor = vec4(vec3(0.18, 0.2, 0.24) + 0.8 * pow(1.0 - s * s, 6.0), 1.0); })"));
    character.root->getOrCreateStateSet()->setAttribute(program);
    return character.root;
}
