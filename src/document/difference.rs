//! Names the keys in which two settings differ.

use serde::Serialize;
use serde_json::Value;

/// Paths of the keys in which two settings differ, such as `spheres.radius`, in order. A table
/// that only one of them has counts as one key.
pub fn differing_keys<T: Serialize>(a: &T, b: &T) -> Vec<String> {
    let value = |settings| serde_json::to_value(settings).expect("settings have text keys");
    let mut keys = Vec::new();
    compare("", &value(a), &value(b), &mut keys);
    keys
}

fn compare(path: &str, a: &Value, b: &Value, keys: &mut Vec<String>) {
    let (Value::Object(a), Value::Object(b)) = (a, b) else {
        // As texts: numbers that are equal, 0 and -0, need not give the same bits.
        let [a, b] = [a, b].map(ToString::to_string);
        if a != b {
            keys.push(path.to_owned());
        }
        return;
    };
    let names: std::collections::BTreeSet<_> = a.keys().chain(b.keys()).collect();
    for name in names {
        let path = if path.is_empty() {
            name.clone()
        } else {
            format!("{path}.{name}")
        };
        let absent = &Value::Null;
        compare(
            &path,
            a.get(name).unwrap_or(absent),
            b.get(name).unwrap_or(absent),
            keys,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn names_every_differing_key_by_its_path() {
        let a =
            json!({"spheres": {"count": 4, "radius": 0.004}, "swirl": {"omega": 4.0}, "seed": 1});
        let b = json!({"spheres": {"count": 5, "radius": 0.004}, "seed": 2});
        assert_eq!(differing_keys(&a, &b), ["seed", "spheres.count", "swirl"]);
        assert!(differing_keys(&a, &a).is_empty());
    }

    #[test]
    fn zeros_of_another_sign_differ() {
        let [a, b] = [0.0, -0.0].map(|zero| json!({"x": zero, "list": [1.0, zero], "same": 1.0}));
        assert_eq!(differing_keys(&a, &b), ["list", "x"]);
    }

    #[test]
    fn lists_are_one_key() {
        let (a, b) = (
            json!({"radius": [1.0, 2.0]}),
            json!({"radius": [1.0, 2.0, 3.0]}),
        );
        assert_eq!(differing_keys(&a, &b), ["radius"]);
    }
}
