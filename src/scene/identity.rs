//! The identity of a run: a hash of everything that determines its motion.

use super::{Contact, Door, Friction, Geometry, Outlet, Rest, Rolling, SceneWall};
use super::{
    DemScene, Driven, Effects, ExternalProgram, Guards, Neighbours, Output, Periodic,
    ProgramParameters, ProgramResume, ProgramStates, ProgramTable, Scene, Spheres, Spot, Start,
    Steady, Tank, TemplateFile, Time,
};
use serde::Serialize;

/// The keys that determine the motion, in the order in which identities are computed. Random
/// numbers derive from the identity, so another order would change the motion.
#[derive(Serialize)]
struct MotionKeys<'a> {
    seed: u64,
    spheres: &'a Spheres,
    #[serde(skip_serializing_if = "Option::is_none")]
    contact: &'a Option<Contact>,
    #[serde(skip_serializing_if = "Option::is_none")]
    friction: &'a Option<Friction>,
    #[serde(skip_serializing_if = "Option::is_none")]
    friction_form: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rolling: &'a Option<Rolling>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tank: &'a Option<Tank>,
    /// Without their names.
    #[serde(rename = "wall", skip_serializing_if = "Vec::is_empty")]
    walls: Vec<SceneWall>,
    #[serde(skip_serializing_if = "Option::is_none")]
    periodic: &'a Option<Periodic>,
    #[serde(skip_serializing_if = "Option::is_none")]
    geometry: &'a Option<Geometry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    door: &'a Option<Door>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rest: &'a Option<Rest>,
    #[serde(skip_serializing_if = "Option::is_none")]
    outlet: &'a Option<Outlet>,
    start: &'a Start,
    #[serde(skip_serializing_if = "is_empty")]
    driven: &'a [Driven],
    #[serde(skip_serializing_if = "Option::is_none")]
    spot: &'a Option<Spot>,
    #[serde(flatten)]
    effects: &'a Effects,
    time: &'a Time,
    guards: &'a Guards,
    #[serde(skip_serializing_if = "Option::is_none")]
    steady: Option<&'a Steady>,
    /// As in the default.
    output: Output,
}

/// The keys that determine what another program does and what is read of it.
#[derive(Serialize)]
struct ProgramKeys<'a> {
    seed: u64,
    parameters: &'a ProgramParameters,
    commands: &'a [Vec<String>],
    files: &'a [TemplateFile],
    read: &'a [ProgramTable],
    states: &'a Option<ProgramStates>,
    version: &'a [String],
    found_version: &'a Option<String>,
    resume: &'a Option<ProgramResume>,
    exit_codes: &'a [i32],
}

fn is_empty(driven: &&[Driven]) -> bool {
    driven.is_empty()
}

fn identity(keys: &impl Serialize) -> String {
    // Numbers are written shortest-round-trip, so the text is canonical. It is hashed while it
    // is written, because a start with a million spheres would make a long text.
    let mut hasher = blake3::Hasher::new();
    serde_json::to_writer(&mut hasher, keys).expect("a scene holds no map with odd keys");
    hasher.finalize().to_hex()[..16].to_owned()
}

impl Scene {
    /// Sixteen hexadecimal digits that stand for everything that determines the motion: all keys
    /// except `title`, `neighbours`, `label`, `measure` and `output`, and the form of the laws.
    /// Runs of equal identity have equal bits. Every random number of a run derives from the
    /// identity (without the form of a law).
    pub fn identity(&self) -> String {
        match &self.program {
            Some(program) => identity(&self.keys_of(program)),
            None => identity(&self.motion()),
        }
    }

    /// Neither the time that a run may take nor what is kept of it changes what it measures.
    fn keys_of<'a>(&'a self, program: &'a ExternalProgram) -> ProgramKeys<'a> {
        let ExternalProgram {
            commands,
            files,
            read,
            states,
            units: _,
            version,
            found_version,
            resume,
            exit_codes,
            retries: _,
            time_limit: _,
            most_bytes: _,
            keep: _,
        } = program;
        ProgramKeys {
            seed: self.seed,
            parameters: &self.parameters,
            commands,
            files,
            read,
            states,
            version,
            found_version,
            resume,
            exit_codes,
        }
    }

    fn motion(&self) -> MotionKeys<'_> {
        let Self {
            title: _,
            seed,
            spheres,
            tank,
            start,
            dem,
            spot,
            program: _,
            parameters: _,
            accuracy: _,
            time,
            steady,
            labels: _,
            measures: _,
            output: _,
        } = self;
        let DemScene {
            contact,
            friction,
            rolling,
            walls,
            periodic,
            geometry,
            door,
            rest,
            outlet,
            driven,
            effects,
            neighbours: _,
            guards,
        } = dem;
        MotionKeys {
            seed: *seed,
            spheres,
            contact,
            friction,
            friction_form: friction.as_ref().and_then(Friction::form),
            rolling,
            tank,
            walls: walls.iter().map(SceneWall::without_name).collect(),
            periodic,
            geometry,
            door,
            rest,
            outlet,
            start,
            driven,
            spot,
            effects,
            time,
            guards,
            steady: steady.as_ref(),
            output: Output::default(),
        }
    }

    /// The scene without title, neighbour search and the limits of a program, which do not affect
    /// results.
    pub(crate) fn without_names(self) -> Self {
        Self {
            title: None,
            program: self.program.map(ExternalProgram::without_limits),
            dem: DemScene {
                neighbours: Neighbours::default(),
                ..self.dem
            },
            ..self
        }
    }

    /// The random stream of this run for one `purpose`. Streams of different purposes or of
    /// different runs are independent. `steady` is left out: it ends a run but does not change it,
    /// so that a run without it continues with the same bits. The form of a law is left out too, so
    /// that a run starts as it did with the earlier form.
    pub fn random_stream(&self, purpose: &str) -> rand_pcg::Pcg64 {
        use rand::SeedableRng;
        let mut hasher = blake3::Hasher::new();
        let without_end = MotionKeys {
            steady: None,
            friction_form: None,
            ..self.motion()
        };
        hasher.update(identity(&without_end).as_bytes());
        hasher.update(purpose.as_bytes());
        rand_pcg::Pcg64::from_seed(*hasher.finalize().as_bytes())
    }
}
