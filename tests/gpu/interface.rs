//! Resolved shaders: the driver finds the same programs in them, and the tables agree with it.

#![expect(unsafe_code, reason = "programs are linked and asked by raw calls")]

use std::collections::{BTreeMap, BTreeSet};

use glow::HasContext as _;
use varikernel::Gl;
use varikernel::gl::{Interface, ShaderSource, ShaderStage, TextureFormat, Variable};
use varikernel::radius::shader_sources;

use crate::shaders::{all_settings, all_sources};
use crate::support::egl;

/// Names and types of a program's active uniforms and attributes, and where its targets are.
#[derive(Debug, PartialEq, Eq)]
struct Active {
    uniforms: BTreeMap<String, u32>,
    attributes: BTreeMap<String, (u32, i32)>,
}

/// A linked program, deleted in the end.
struct Linked<'a> {
    gl: &'a Gl,
    program: glow::Program,
}

impl<'a> Linked<'a> {
    fn new(gl: &'a Gl, vertex: &str, fragment: &str) -> Self {
        let glow = gl.glow();
        // SAFETY: the context is current, and the names are ours.
        unsafe {
            let program = glow.create_program().unwrap();
            for (stage, text) in [(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, fragment)] {
                let shader = glow.create_shader(stage).unwrap();
                glow.shader_source(shader, text);
                glow.compile_shader(shader);
                let log = glow.get_shader_info_log(shader);
                assert!(glow.get_shader_compile_status(shader), "{log}\n{text}");
                glow.attach_shader(program, shader);
                glow.delete_shader(shader);
            }
            glow.link_program(program);
            let log = glow.get_program_info_log(program);
            assert!(glow.get_program_link_status(program), "{log}\n{vertex}\n{fragment}");
            Self { gl, program }
        }
    }

    fn active(&self) -> Active {
        let (glow, program) = (self.gl.glow(), self.program);
        // SAFETY: the context is current, and the program is linked.
        unsafe {
            let uniforms = (0..glow.get_active_uniforms(program))
                .map(|index| glow.get_active_uniform(program, index).unwrap())
                .map(|uniform| (uniform.name, uniform.utype));
            let attributes = (0..glow.get_active_attributes(program))
                .map(|index| glow.get_active_attribute(program, index).unwrap())
                .filter(|attribute| !attribute.name.starts_with("gl_"))
                .map(|attribute| {
                    let location = glow.get_attrib_location(program, &attribute.name).unwrap();
                    (attribute.name, (attribute.atype, location.cast_signed()))
                });
            Active { uniforms: uniforms.collect(), attributes: attributes.collect() }
        }
    }

    fn target_location(&self, name: &str) -> i32 {
        // SAFETY: the context is current, and the program is linked.
        unsafe { self.gl.glow().get_frag_data_location(self.program, name) }
    }
}

impl Drop for Linked<'_> {
    fn drop(&mut self) {
        // SAFETY: the context is current, and the name is ours.
        unsafe { self.gl.glow().delete_program(self.program) };
    }
}

/// The GL enum of a type's name; by the specification's table 2.10.
fn enum_of(glsl_type: &str) -> u32 {
    match glsl_type {
        "int" => glow::INT,
        "uint" => glow::UNSIGNED_INT,
        "float" => glow::FLOAT,
        "ivec2" => glow::INT_VEC2,
        "vec3" => glow::FLOAT_VEC3,
        "vec4" => glow::FLOAT_VEC4,
        "mat4" => glow::FLOAT_MAT4,
        "sampler2D" => glow::SAMPLER_2D,
        "usampler2D" => glow::UNSIGNED_INT_SAMPLER_2D,
        "usampler2DArray" => glow::UNSIGNED_INT_SAMPLER_2D_ARRAY,
        other => panic!("{other} is new"),
    }
}

/// What a table lacks or has wrong about a program.
fn untruths(table: &Interface, program: &Linked<'_>) -> Vec<String> {
    let active = program.active();
    let types = |list: &[Variable]| {
        list.iter()
            .map(|variable| (variable.name.clone(), enum_of(&variable.glsl_type)))
            .collect::<BTreeMap<_, _>>()
    };
    let mut uniforms = types(&table.samplers);
    uniforms.extend(types(&table.uniforms));
    let attributes: BTreeMap<_, _> = table
        .attributes
        .iter()
        .map(|variable| {
            let location = variable.location.unwrap().cast_signed();
            (variable.name.clone(), (enum_of(&variable.glsl_type), location))
        })
        .collect();
    let mut untruths = Vec::new();
    for (name, kind) in &active.uniforms {
        if uniforms.get(name) != Some(kind) {
            untruths.push(format!("uniform {name} is {kind:#x}, not {:x?}", uniforms.get(name)));
        }
    }
    for (name, fact) in &active.attributes {
        if attributes.get(name) != Some(fact) {
            untruths.push(format!("attribute {name} is {fact:x?}, not {:x?}", attributes.get(name)));
        }
    }
    for target in &table.targets {
        let (said, found) = (target.location.unwrap().cast_signed(), program.target_location(&target.name));
        if said != found {
            untruths.push(format!("target {} is at {found}, not {said}", target.name));
        }
    }
    untruths
}

fn linked<'a>(gl: &'a Gl, source: &ShaderSource) -> Linked<'a> {
    Linked::new(gl, &source.resolved(ShaderStage::Vertex), &source.resolved(ShaderStage::Fragment))
}

#[test]
fn resolved_shaders_have_the_same_uniforms_and_the_tables_hold_them_all() {
    let gl = egl();
    for source in all_sources() {
        let name = source.name();
        for stage in ShaderStage::ALL {
            let text = source.resolved(stage);
            let directives: Vec<_> = text.lines().filter(|line| line.starts_with('#')).collect();
            assert_eq!(directives, ["#version 330 core"], "{name}");
        }
        let program = linked(&gl, &source);
        let unresolved = Linked::new(&gl, &source.vertex(), &source.fragment());
        assert_eq!(program.active(), unresolved.active(), "{name}");

        let table = source.interface();
        assert_eq!(untruths(&table, &program), [""; 0], "{name}");
        for (what, list) in table.lists() {
            for variable in list {
                let meaning = &variable.meaning;
                assert!(meaning.ends_with('.'), "{name}, {what}: {} means \"{meaning}\"", variable.name);
            }
        }
        assert!(table.targets.iter().all(|target| target.format.is_some()), "{name}: a format is not known");
        assert!(source.purpose().ends_with('.'), "{name}: \"{}\"", source.purpose());
    }
}

#[test]
fn an_untrue_table_is_seen() {
    let gl = egl();
    let source = all_sources().into_iter().find(|source| source.name() == "surfaces-of-triangles").unwrap();
    let program = linked(&gl, &source);
    let truth = source.interface();
    assert_eq!(untruths(&truth, &program), [""; 0]);

    let lie = |change: &dyn Fn(&mut Interface)| {
        let mut table = truth.clone();
        change(&mut table);
        untruths(&table, &program).len()
    };
    assert_eq!(lie(&|table| table.uniforms[0].glsl_type = "int".to_owned()), 1);
    assert_eq!(lie(&|table| drop(table.uniforms.pop())), 1);
    assert_eq!(lie(&|table| table.attributes[0].glsl_type = "float".to_owned()), 1);
    assert_eq!(lie(&|table| table.attributes[1].location = Some(3)), 1);
    assert_eq!(lie(&|table| table.targets[2].location = Some(1)), 1);
}

#[test]
fn no_two_shaders_of_one_frame_share_a_name() {
    for settings in all_settings() {
        let mut seen = BTreeSet::new();
        for source in shader_sources(TextureFormat::R32Uint, &settings) {
            let name = source.name();
            assert!(
                name.chars().all(|letter| letter.is_ascii_lowercase()
                    || letter.is_ascii_digit()
                    || "-/".contains(letter)),
                "{name}"
            );
            assert!(seen.insert(name.clone()), "{name} twice: {settings:?}");
        }
    }
}
