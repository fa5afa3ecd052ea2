//! A file that names a program is code: it is started with leave only.

use super::{MODEL, place_of};
use phase::store::read_record;

/// What no command without leave may do: the program and the command of its version leave a file.
const TRACE: &str = "version = [\"sh\", \"-c\", \"echo 1 && touch TRACE\"]";

#[test]
fn only_commands_with_leave_start_programs() {
    let trace = tempfile::tempdir().unwrap();
    let file = trace.path().join("started");
    let more = TRACE.replace("TRACE", file.to_str().unwrap());
    let script = format!("touch {}\n{MODEL}", file.display());
    let place = place_of(&script, "[1.0, 3.0]", &more);
    let refused = place.phase(&["sweep", "model.toml"]).code(2);
    refused
        .complains("model.toml: it starts `sh`")
        .complains("--allow-program");
    for arguments in [
        &["check", "model.toml"][..],
        &["check", "--json", "model.toml"],
        &["jobs", "model.toml"],
        &["cost", "model.toml"],
    ] {
        place.phase(arguments);
        assert!(!file.exists(), "{arguments:?}");
    }
    assert!(!place.path("results").exists());
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(0)
        .says("2 runs labelled");
    std::fs::remove_file(&file).unwrap();
    for arguments in [
        &["status", "results/model"][..],
        &["classify", "results/model"],
        &["plot", "results/model"],
        &["check", "model.toml"],
        &["jobs", "model.toml", "--missing"],
    ] {
        place.phase(arguments).code(0);
        assert!(!file.exists(), "{arguments:?}");
    }
    let record = place.records("results/model").remove(0);
    read_record(&place.path(&format!("results/model/records/{record}"))).unwrap();
    assert!(!file.exists());
}

#[test]
fn the_configuration_of_the_user_lists_files_and_folders() {
    let place = place_of(MODEL, "[1.0]", "");
    let with = |text: Option<&str>| {
        let home = place.path("home");
        std::fs::create_dir_all(home.join("phase")).unwrap();
        if let Some(text) = text {
            std::fs::write(home.join("phase/config.toml"), text).unwrap();
        }
        let mut command = place.command(&["sweep", "model.toml"]);
        command.env("XDG_CONFIG_HOME", &home);
        let output = command.output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        (output.status.code(), said)
    };
    let folder = place.path("").canonicalize().unwrap();
    let (code, said) = with(None);
    assert_eq!(code, Some(2));
    assert!(
        said.contains("phase/config.toml: `programs = [\"/"),
        "{said}"
    );
    for (text, expected) in [
        ("programs = []", "--allow-program"),
        ("programs = [\"model.toml\"]", "--allow-program"),
        ("programs = [\"/nowhere\"]", "--allow-program"),
        ("programs = \"here\"", "it may say `programs = ["),
        ("allowed = []", "it may say `programs = ["),
    ] {
        let (code, said) = with(Some(text));
        assert_eq!(code, Some(2), "{text}");
        assert!(said.contains(expected), "{text}: {said}");
    }
    let file = folder.join("model.toml");
    // A results folder may come from anywhere, so that it is no file of the list.
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(0);
    let mut again = place.command(&["run", "--from", "results/model", "--point", "x=1"]);
    again.env("XDG_CONFIG_HOME", place.path("home"));
    std::fs::write(
        place.path("home/phase/config.toml"),
        format!("programs = [{folder:?}]"),
    )
    .unwrap();
    assert_eq!(again.output().unwrap().status.code(), Some(2));
    for listed in [folder, file] {
        std::fs::remove_dir_all(place.path("results")).ok();
        let (code, said) = with(Some(&format!("programs = [{listed:?}]")));
        assert_eq!(code, Some(0), "{said}");
    }
}
