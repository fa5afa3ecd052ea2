use super::*;
use ndarray::{Array2, array};

const TANK: Stage = Stage {
    radius: Some(0.06),
    sides: [None; 2],
    floor: Some(-0.2),
    lines: Vec::new(),
    seen: [[-0.06, -0.06, -0.2], [0.06, 0.06, -0.08]],
};

const RED: Rgb = [220, 40, 40];
const GREEN: Rgb = [40, 180, 60];

fn snapshot(position: Array2<f64>) -> Snapshot {
    Snapshot {
        velocity: Array2::zeros(position.dim()),
        position,
        ..Snapshot::default()
    }
}

fn is_red([red, green, ..]: [u8; 4]) -> bool {
    red > green.saturating_add(25)
}

fn is_green([red, green, ..]: [u8; 4]) -> bool {
    green > red.saturating_add(25)
}

/// Number of pixels, and the mean column and row of them.
fn spot(image: &Image, belongs: impl Fn([u8; 4]) -> bool) -> (usize, f64, f64) {
    let (mut count, mut x_sum, mut y_sum) = (0, 0.0, 0.0);
    for y in 0..image.height {
        for x in 0..image.width {
            if belongs(image.pixel(x, y)) {
                count += 1;
                x_sum += x as f64 + 0.5;
                y_sum += y as f64 + 0.5;
            }
        }
    }
    (count, x_sum / count as f64, y_sum / count as f64)
}

#[test]
fn a_sphere_is_where_it_is_and_as_large_as_it_is() {
    let all = snapshot(array![[0.03, 0.01, -0.15]]);
    let (side, top) = (Camera::side(&TANK), Camera::top(&TANK));
    for (camera, x, y) in [(side, 0.03, -0.15 + 0.14), (top, 0.03, 0.01)] {
        let image = picture(&all, &[0.02], &[RED], &TANK, &camera, 300, 300);
        let scale = camera.scale(300, 300);
        let (count, column, row) = spot(&image, is_red);
        assert!((column - (150.0 + scale * x)).abs() < 1.5, "{column}");
        assert!((row - (150.0 - scale * y)).abs() < 1.5, "{row}");
        let area = std::f64::consts::PI * 0.02 * 0.02 * scale * scale;
        assert!((count as f64 / area - 1.0).abs() < 0.05, "{count} {area}");
    }
}

#[test]
fn the_nearer_sphere_hides_the_other() {
    // The first is nearer to the camera at the side, the second to the camera above.
    let all = snapshot(array![[0.0, -0.03, -0.17], [0.0, 0.0, -0.15]]);
    let (radius, color) = ([0.01, 0.01], [RED, GREEN]);
    let count = |camera: &Camera, belongs: fn([u8; 4]) -> bool| {
        let image = picture(&all, &radius, &color, &TANK, camera, 200, 200);
        spot(&image, belongs).0
    };
    let same_line = snapshot(array![[0.0, -0.03, -0.15], [0.0, 0.0, -0.15]]);
    let side = Camera::side(&TANK);
    let image = picture(&same_line, &radius, &color, &TANK, &side, 200, 200);
    assert_eq!(spot(&image, is_green).0, 0);
    assert!(count(&side, is_green) > 100 && count(&Camera::top(&TANK), is_red) > 100);
    let above = snapshot(array![[0.0, 0.0, -0.18], [0.0, 0.0, -0.15]]);
    let image = picture(
        &above,
        &radius,
        &color,
        &TANK,
        &Camera::top(&TANK),
        200,
        200,
    );
    assert_eq!(spot(&image, is_red).0, 0);
}

#[test]
fn spheres_that_overlap_meet_in_the_middle() {
    let all = snapshot(array![[-0.01, 0.0, -0.15], [0.01, 0.0, -0.15]]);
    let camera = Camera::side(&TANK);
    let image = picture(&all, &[0.015; 2], &[RED, GREEN], &TANK, &camera, 300, 300);
    let middle = (0..300).map(|y| (image.pixel(145, y), image.pixel(154, y)));
    let (left, right): (Vec<_>, Vec<_>) = middle.unzip();
    assert!(left.iter().any(|&pixel| is_red(pixel)) && !left.iter().any(|&p| is_green(p)));
    assert!(right.iter().any(|&pixel| is_green(pixel)) && !right.iter().any(|&p| is_red(p)));
}

#[test]
fn a_sphere_in_the_light_throws_a_shadow() {
    // The lamp is at the upper left of the viewer: seen from above, the shadow falls to the lower
    // right.
    let low = array![[0.0, 0.0, -0.19]];
    let lit = array![[0.0, 0.0, -0.19], [-0.018, 0.024, -0.15]];
    let camera = Camera::top(&TANK);
    let at_middle = |position| {
        let image = picture(
            &snapshot(position),
            &[0.01; 2],
            &[RED; 2],
            &TANK,
            &camera,
            200,
            200,
        );
        image.pixel(100, 100)[0]
    };
    assert!(at_middle(lit) + 40 < at_middle(low));
}

#[test]
fn everything_odd_is_a_picture() {
    let empty = Stage::new(None, None);
    for position in [
        Array2::zeros((0, 3)),
        array![[f64::NAN, 0.0, 0.0]],
        array![[1e300, 0.0, 0.0]],
        array![[0.0, 0.0, 0.0]],
        array![[1e9, -1e9, 1e9]],
    ] {
        let all = snapshot(position);
        for stage in [
            TANK,
            empty.clone(),
            TANK.around([&all], &[0.01]),
            empty.clone().around([&all], &[0.01]),
        ] {
            for camera in [0.0, 30.0, 90.0].map(|elevation| Camera::raised(&stage, elevation)) {
                let image = picture(&all, &[0.01], &[RED], &stage, &camera, 20, 10);
                assert_eq!(image.rgba.len(), 4 * 20 * 10);
                assert!(image.rgba.chunks(4).all(|pixel| pixel[3] == 255));
            }
        }
    }
    picture(
        &snapshot(array![[0.0, 0.0, 0.0]]),
        &[0.01],
        &[RED],
        &TANK,
        &Camera::top(&TANK),
        0,
        0,
    );
}

#[test]
fn view_has_the_proportions_of_the_stage() {
    let aspect = |camera: Camera| camera.aspect();
    assert!((aspect(Camera::side(&TANK)) - 1.0).abs() < 1e-12);
    assert!((aspect(Camera::side(&TANK.up_to(0.04))) - 0.5).abs() < 1e-12);
    assert!((aspect(Camera::top(&TANK.up_to(0.04))) - 1.0).abs() < 1e-12);
    let high = snapshot(array![[0.0, 0.0, 0.15]]);
    assert_eq!(TANK.around([&high], &[0.01]).seen[1][2], 0.16);
}

#[test]
fn colors_follow_what_they_stand_for() {
    let mut all = snapshot(array![[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]);
    let radius = [0.01, 0.02, 0.03];
    all.velocity = array![[3.0, 0.0, 4.0], [0.0, 0.0, 0.0], [0.0, 0.0, 2.5]];
    assert_eq!(ColorBy::speed_of([&all]), ColorBy::Speed { fastest: 5.0 });
    let height = ColorBy::height_of([&all]);
    assert_eq!(
        height,
        ColorBy::Height {
            low: 0.0,
            high: 2.0
        }
    );
    let (by_speed, by_height) = (
        ColorBy::speed_of([&all]).colors(&all, &radius),
        height.colors(&all, &radius),
    );
    assert_eq!([by_height[2], by_height[0], by_height[1]], by_speed[..]);
    let by_radius = ColorBy::radius_of(&radius).colors(&all, &radius);
    assert_eq!(by_radius, by_height);
    let by_index = ColorBy::Index.colors(&all, &radius);
    assert!(by_index[0] != by_index[1] && by_index[1] != by_index[2]);
    // Nothing moves, or all is at one height.
    let rest = snapshot(array![[0.0, 0.0, 1.0]]);
    for by in [ColorBy::speed_of([&rest]), ColorBy::height_of([&rest])] {
        assert_eq!(by.colors(&rest, &[0.01]), [by_speed[1]]);
    }
}

#[test]
fn png_of_a_palette_holds_few_colors_exactly_and_is_smaller() {
    let colors = [[10, 20, 30, 255], [200, 100, 0, 255], [255, 255, 255, 255]];
    let pixels = (0..64 * 64).flat_map(|pixel| colors[pixel * pixel % 3]);
    let image = Image {
        width: 64,
        height: 64,
        rgba: pixels.collect(),
    };
    let file = image.to_png_of_palette(&[]).unwrap();
    assert!(file.len() < image.to_png(&[]).unwrap().len());
    let mut decoder = png::Decoder::new(std::io::Cursor::new(file));
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().unwrap();
    let mut found = vec![0; 3 * 64 * 64];
    reader.next_frame(&mut found).unwrap();
    let opaque = image.rgba.chunks_exact(4).flat_map(|pixel| &pixel[..3]);
    assert!(found.iter().eq(opaque));
}

#[test]
fn png_holds_the_pixels_and_the_texts() {
    let mut image = Image::white(3, 2);
    image.paste(
        &Image {
            width: 1,
            height: 1,
            rgba: vec![1, 2, 3, 255],
        },
        2,
        1,
    );
    let file = image
        .to_png(&[("Title", "Ω".to_owned()), ("Software", "phase".to_owned())])
        .unwrap();
    let decoder = png::Decoder::new(std::io::Cursor::new(file));
    let mut reader = decoder.read_info().unwrap();
    let mut pixels = vec![0; 24];
    reader.next_frame(&mut pixels).unwrap();
    assert_eq!(pixels, image.rgba);
    assert_eq!(image.pixel(2, 1), [1, 2, 3, 255]);
    assert_eq!(reader.info().utf8_text[0].get_text().unwrap(), "Ω");
    assert_eq!(reader.info().uncompressed_latin1_text[0].text, "phase");
}

/// Symptom: half of a drum was outside its picture. Cause: a stage with a single point counted as
/// empty, so that each further point of an outline took the place of those before it.
#[test]
fn a_stage_holds_all_of_its_walls() {
    let text = "
        spheres = { count = 1, radius = 0.01, density = 1000 }
        start = { kind = 'list', spheres = [{ position = [0, 0, 0] }] }
        time = { dt = 1e-3, duration = 0.1, frame_interval = 0.01 }
        wall = [{ cylinder = { base = [0, -1, 2], axis = [0, 1, 0], radius = 0.5, length = 2 } }]
    ";
    let scene: crate::scene::Scene = toml::from_str(text).unwrap();
    let [low, high] = Stage::of_scene(&scene).seen;
    let expected = [[-0.5, -1.0, 1.5], [0.5, 1.0, 2.5]];
    for (found, expected) in [low, high].into_iter().zip(expected) {
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 2e-3, "{low:?} {high:?}");
        }
    }
}
