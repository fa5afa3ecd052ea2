//! The commands: one file each. No command imports another.

mod check;
mod classify;
mod compare;
mod cost;
mod export;
mod fit;
mod generate;
mod jobs;
mod merge;
mod new;
mod plot;
mod report;
mod run;
mod status;
mod study;
mod submit;
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
    Report(report::Arguments),
    Run(run::Arguments),
    Export(export::Arguments),
    View(view::Arguments),
    Check(check::Arguments),
    Cost(cost::Arguments),
    Compare(compare::Arguments),
    Fit(fit::Arguments),
    Study(study::Arguments),
    Jobs(jobs::Arguments),
    Submit(submit::Arguments),
    Status(status::Arguments),
    Merge(merge::Arguments),
    Verify(verify::Arguments),
    New(new::Arguments),
    Generate(generate::Arguments),
}

impl Command {
    /// Whether the command has a result for programs.
    pub(super) fn has_answer(&self) -> bool {
        !matches!(self, Self::New(_) | Self::Generate(_))
    }

    /// Does what the command says.
    pub(super) fn execute(&self, console: &Console) -> Result<Exit, Failure> {
        match self {
            Self::Sweep(arguments) => sweep::main(arguments, console),
            Self::Classify(arguments) => classify::main(arguments, console),
            Self::Plot(arguments) => plot::main(arguments, console),
            Self::Report(arguments) => report::main(arguments, console),
            Self::Run(arguments) => run::main(arguments, console),
            Self::Export(arguments) => export::main(arguments, console),
            Self::View(arguments) => view::main(arguments, console),
            Self::Check(arguments) => check::main(arguments, console),
            Self::Cost(arguments) => cost::main(arguments, console),
            Self::Compare(arguments) => compare::main(arguments, console),
            Self::Fit(arguments) => fit::main(arguments, console),
            Self::Study(arguments) => study::main(arguments, console),
            Self::Jobs(arguments) => jobs::main(arguments, console),
            Self::Submit(arguments) => submit::main(arguments, console),
            Self::Status(arguments) => status::main(arguments, console),
            Self::Merge(arguments) => merge::main(arguments, console),
            Self::Verify(arguments) => verify::main(arguments, console),
            Self::New(arguments) => new::main(arguments, console),
            Self::Generate(arguments) => generate::main(arguments, console),
        }
    }
}
