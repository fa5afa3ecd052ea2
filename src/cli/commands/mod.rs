//! The commands: one file each. No command imports another.

mod check;
mod classify;
mod compare;
mod completions;
mod cost;
mod export;
mod fit;
mod man;
mod new;
mod plot;
mod reference;
mod run;
mod schema;
mod status;
mod study;
mod sweep;
mod verify;
mod view;

use super::console::Console;
use super::exit::{Exit, Failure};
use clap::Subcommand;

#[derive(Subcommand)]
pub(super) enum Command {
    Sweep(sweep::Arguments),
    Classify(classify::Arguments),
    Plot(plot::Arguments),
    Run(run::Arguments),
    Export(export::Arguments),
    View(view::Arguments),
    Check(check::Arguments),
    Cost(cost::Arguments),
    Compare(compare::Arguments),
    Fit(fit::Arguments),
    Study(study::Arguments),
    Status(status::Arguments),
    Verify(verify::Arguments),
    New(new::Arguments),
    Schema(schema::Arguments),
    Reference(reference::Arguments),
    Completions(completions::Arguments),
    Man(man::Arguments),
}

impl Command {
    /// Whether the result is for a program.
    pub(super) fn wants_json(&self) -> bool {
        match self {
            Self::Sweep(arguments) => arguments.json,
            Self::Classify(arguments) => arguments.json,
            Self::Plot(arguments) => arguments.json,
            Self::Run(arguments) => arguments.json,
            Self::Export(arguments) => arguments.json,
            Self::View(arguments) => arguments.json,
            Self::Check(arguments) => arguments.json,
            Self::Cost(arguments) => arguments.json,
            Self::Compare(arguments) => arguments.json,
            Self::Fit(arguments) => arguments.json,
            Self::Study(arguments) => arguments.options.json,
            Self::Status(arguments) => arguments.json,
            Self::Verify(arguments) => arguments.json,
            _ => false,
        }
    }

    /// Does what the command says.
    pub(super) fn execute(&self, console: &Console) -> Result<Exit, Failure> {
        match self {
            Self::Sweep(arguments) => sweep::main(arguments, console),
            Self::Classify(arguments) => classify::main(arguments, console),
            Self::Plot(arguments) => plot::main(arguments, console),
            Self::Run(arguments) => run::main(arguments, console),
            Self::Export(arguments) => export::main(arguments, console),
            Self::View(arguments) => view::main(arguments, console),
            Self::Check(arguments) => check::main(arguments, console),
            Self::Cost(arguments) => cost::main(arguments, console),
            Self::Compare(arguments) => compare::main(arguments, console),
            Self::Fit(arguments) => fit::main(arguments, console),
            Self::Study(arguments) => study::main(arguments, console),
            Self::Status(arguments) => status::main(arguments, console),
            Self::Verify(arguments) => verify::main(arguments, console),
            Self::New(arguments) => new::main(arguments, console),
            Self::Schema(arguments) => schema::main(arguments, console),
            Self::Reference(arguments) => reference::main(arguments, console),
            Self::Completions(arguments) => completions::main(arguments, console),
            Self::Man(arguments) => man::main(arguments, console),
        }
    }
}
