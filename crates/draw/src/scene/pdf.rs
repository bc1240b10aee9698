//! Scenes as PDF: one page of lines, areas and words that can be selected, with the font inside.

use super::font::{self, face};
use super::words::{INDEX_DROP, INDEX_SIZE, runs};
use super::{Colour, Item, Point, Scene, Segment, Stroke, Words};
use pdf_writer::types::{CidFontType, FontFlags, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str};
use std::collections::BTreeMap;

/// Points of print per unit: 96 units are an inch, as in CSS.
const POINTS: f64 = 0.75;
/// The name of the font in the file.
const FONT: Name<'static> = Name(b"JURIST+DejaVuSans");
/// How the two bytes of a letter name its glyph.
const SYSTEM: SystemInfo<'static> = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };
/// A circle's quarter as a cubic curve: the distance of its control points.
const QUARTER: f64 = 0.552_284_75;

impl Scene {
    /// The scene as a PDF document of one page. Nothing of the time or place enters it.
    pub fn pdf(&self) -> Vec<u8> {
        let [catalog, pages, page, contents, type0, cid, descriptor, file, cmap] =
            std::array::from_fn(|k| Ref::new(i32::try_from(k).expect("there are nine") + 1));
        let mut writer = Writer { content: Content::new(), used: BTreeMap::new() };
        // Downwards from the upper left corner, in units.
        let p = POINTS as f32;
        writer.content.transform([p, 0.0, 0.0, -p, 0.0, (self.height * POINTS) as f32]);
        writer.content.set_line_join(LineJoinStyle::RoundJoin);
        writer.items(&self.items);
        let used = writer.used;

        let mut pdf = Pdf::new();
        pdf.catalog(catalog).pages(pages);
        pdf.pages(pages).kids([page]).count(1);
        let mut sheet = pdf.page(page);
        sheet.media_box(Rect::new(0.0, 0.0, (self.width * POINTS) as f32, (self.height * POINTS) as f32));
        sheet.parent(pages).contents(contents);
        sheet.resources().fonts().pair(Name(b"F"), type0);
        sheet.finish();
        let compressed = |data: &[u8]| miniz_oxide::deflate::compress_to_vec_zlib(data, 6);
        pdf.stream(contents, &compressed(&writer.content.finish())).filter(Filter::FlateDecode);

        pdf.type0_font(type0)
            .base_font(FONT)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(cid)
            .to_unicode(cmap);
        let face = face();
        let thousandths = |units: f32| 1000.0 * units / f32::from(face.units_per_em());
        let mut glyphs = pdf.cid_font(cid);
        glyphs.subtype(CidFontType::Type2).base_font(FONT).system_info(SYSTEM).font_descriptor(descriptor);
        glyphs.cid_to_gid_map_predefined(Name(b"Identity"));
        let mut widths = glyphs.widths();
        for glyph in used.keys() {
            let advance = face.glyph_hor_advance(ttf_parser::GlyphId(*glyph)).unwrap_or(0);
            widths.consecutive(*glyph, [thousandths(f32::from(advance))]);
        }
        widths.finish();
        glyphs.finish();
        let b = face.global_bounding_box();
        let [left, lower, right, upper] = [b.x_min, b.y_min, b.x_max, b.y_max].map(|v| thousandths(f32::from(v)));
        pdf.font_descriptor(descriptor)
            .name(FONT)
            .flags(FontFlags::NON_SYMBOLIC)
            .bbox(Rect::new(left, lower, right, upper))
            .italic_angle(0.0)
            .ascent(thousandths(f32::from(face.ascender())))
            .descent(thousandths(f32::from(face.descender())))
            .cap_height(thousandths(f32::from(face.capital_height().unwrap_or(face.ascender()))))
            .stem_v(80.0)
            .font_file2(file);
        pdf.stream(file, &compressed(font::FILE))
            .filter(Filter::FlateDecode)
            .pair(Name(b"Length1"), i32::try_from(font::FILE.len()).unwrap_or(i32::MAX));
        let mut names = UnicodeCmap::new(Name(b"Letters"), SYSTEM);
        for (glyph, letter) in &used {
            names.pair(*glyph, *letter);
        }
        pdf.cmap(cmap, &names.finish());
        pdf.finish()
    }
}

struct Writer {
    content: Content,
    /// The glyphs that are used, with the letter of each.
    used: BTreeMap<u16, char>,
}

fn f((x, y): Point) -> (f32, f32) {
    // A number that is not finite would end the document.
    let finite = |v: f64| if v.is_finite() { v as f32 } else { 0.0 };
    (finite(x), finite(y))
}

impl Writer {
    fn items(&mut self, items: &[Item]) {
        for item in items {
            match item {
                Item::Path { segments, fill, stroke } => self.path(segments, *fill, stroke.as_ref()),
                Item::Circle { centre: (x, y), radius: r, fill, stroke } => {
                    let k = QUARTER * r;
                    let quarter = |a: Point, b: Point, to: Point| Segment::Cubic(a, b, to);
                    let circle = [
                        Segment::Move((x + r, *y)),
                        quarter((x + r, y + k), (x + k, y + r), (*x, y + r)),
                        quarter((x - k, y + r), (x - r, y + k), (x - r, *y)),
                        quarter((x - r, y - k), (x - k, y - r), (*x, y - r)),
                        quarter((x + k, y - r), (x + r, y - k), (x + r, *y)),
                        Segment::Close,
                    ];
                    self.path(&circle, *fill, stroke.as_ref());
                }
                Item::Words(words) => self.words(words),
                Item::Sign { items, .. } | Item::Legend { items, .. } => self.items(items),
                Item::Group { offset, clip, items } => {
                    self.content.save_state();
                    let (x, y) = f(*offset);
                    self.content.transform([1.0, 0.0, 0.0, 1.0, x, y]);
                    if let Some(c) = clip {
                        self.content.rect(c.left as f32, c.top as f32, c.width as f32, c.height as f32);
                        self.content.clip_nonzero().end_path();
                    }
                    self.items(items);
                    self.content.restore_state();
                }
            }
        }
    }

    fn path(&mut self, segments: &[Segment], fill: Option<Colour>, stroke: Option<&Stroke>) {
        if segments.is_empty() || (fill.is_none() && stroke.is_none()) {
            return;
        }
        let share = |v: u8| f32::from(v) / 255.0;
        if let Some(Colour(r, g, b)) = fill {
            self.content.set_fill_rgb(share(r), share(g), share(b));
        }
        if let Some(Stroke { colour: Colour(r, g, b), width, dashes }) = stroke {
            self.content.set_stroke_rgb(share(*r), share(*g), share(*b)).set_line_width(*width as f32);
            self.content.set_dash_pattern(dashes.iter().map(|d| *d as f32), 0.0);
        }
        for segment in segments {
            let content = &mut self.content;
            match segment {
                Segment::Move(p) => content.move_to(f(*p).0, f(*p).1),
                Segment::Line(p) => content.line_to(f(*p).0, f(*p).1),
                Segment::Cubic(a, b, p) => content.cubic_to(f(*a).0, f(*a).1, f(*b).0, f(*b).1, f(*p).0, f(*p).1),
                Segment::Close => content.close_path(),
            };
        }
        match (fill.is_some(), stroke.is_some()) {
            (true, true) => self.content.fill_nonzero_and_stroke(),
            (true, false) => self.content.fill_nonzero(),
            _ => self.content.stroke(),
        };
    }

    /// Letters behind their halo, which is the outline of the same letters.
    fn words(&mut self, words: &Words) {
        if let Some(halo) = words.halo.filter(|_| !words.turned) {
            let mut at = (words.at.0 - words.before(), words.at.1);
            for run in runs(&words.text) {
                let (size, drop) = sizes(words, run.lowered);
                let outline = font::outlines(run.text, size, (at.0, at.1 + drop));
                self.path(&outline, None, Some(&Stroke::new(halo, 3.0)));
                at.0 += font::advance(run.text, size);
            }
        }
        let share = |v: u8| f32::from(v) / 255.0;
        let Colour(r, g, b) = words.colour;
        self.content.set_fill_rgb(share(r), share(g), share(b));
        self.content.begin_text();
        let mut along = -words.before();
        for run in runs(&words.text) {
            let (size, drop) = sizes(words, run.lowered);
            // Letters stand upright, where the page counts downwards.
            let matrix = if words.turned {
                let (x, y) = f((words.at.0 + drop, words.at.1 - along));
                [0.0, -1.0, -1.0, 0.0, x, y]
            } else {
                let (x, y) = f((words.at.0 + along, words.at.1 + drop));
                [1.0, 0.0, 0.0, -1.0, x, y]
            };
            let mut bytes = Vec::with_capacity(2 * run.text.len());
            for letter in run.text.chars() {
                let glyph = font::glyph(letter).0;
                self.used.entry(glyph).or_insert(letter);
                bytes.extend(glyph.to_be_bytes());
            }
            self.content.set_font(Name(b"F"), size as f32).set_text_matrix(matrix).show(Str(&bytes));
            along += font::advance(run.text, size);
        }
        self.content.end_text();
    }
}

fn sizes(words: &Words, lowered: bool) -> (f64, f64) {
    if lowered { (INDEX_SIZE * words.size, INDEX_DROP * words.size) } else { (words.size, 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_has_a_page_and_ends_and_is_the_same_every_time() {
        let mut scene = Scene::new(200.0, 100.0);
        scene.circle((50.0, 50.0), 10.0, Some(Colour::BLACK), None);
        scene.words(Words::new("K_pwm = 3 µs", (20.0, 20.0), 12.0, Colour::BLACK).turned());
        let bytes = scene.pdf();
        assert!(bytes.starts_with(b"%PDF-1.") && bytes.ends_with(b"%%EOF") && bytes == scene.pdf());
        let text = String::from_utf8_lossy(&bytes);
        assert!(text.contains("/MediaBox [0 0 150 75]") && text.contains("/ToUnicode"), "{}", &text[..400]);
    }
}
