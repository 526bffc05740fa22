//! A result file as one HTML page that needs nothing else: inputs, what follows from them, the verdict, and all figures that fit, with values
//! under the pointer and zoom.

mod content;
mod data;

use std::fmt::Write;
use std::path::Path;

use crate::error::Result;
use crate::figures::Results;
use crate::figures::drawing::{Drawing, escaped};

const STYLE: &str = include_str!("page/report.css");
const SCRIPT: &str = include_str!("page/report.js");

/// What a reader may do with a figure.
const HINT: &str = "Point: values. Drag, or Ctrl and wheel: enlarge. Double click: back.";

/// Forbids a page to load anything, whatever is in the file.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

/// Something to be read, above the figures or below.
struct Section {
    heading: &'static str,
    parts: Vec<Part>,
}

enum Part {
    /// Names and values; a gap where both are empty.
    Rows(Vec<(String, String)>),
    /// A head and rows of cells.
    Table(Vec<String>, Vec<Vec<String>>),
    /// Text as it was written.
    Text(String),
    /// A sentence.
    Sentence(String),
}

/// What a file comes to.
struct Verdict {
    /// The first says most.
    sentences: Vec<String>,
    /// Whether something deserves a second look.
    doubtful: bool,
}

/// The page of a result file that has been read from `path`.
///
/// # Errors
/// As [`Results::figure`], and those of what follows from a scene.
pub fn report(results: &Results, path: &Path) -> Result<String> {
    let content::Content { title, program_version, verdict, above, below } = content::of(results, path)?;
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let from = format!("{name}: {} of fretwear {program_version}", results.what());
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>{0}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n\
         <h1>{0}</h1>\n<p class=\"from\">{1}</p>\n",
        escaped(&title),
        escaped(&from)
    );
    let class = if verdict.doubtful { "verdict doubt" } else { "verdict" };
    let sentences: String = verdict.sentences.iter().map(|it| format!("<p>{}</p>\n", escaped(it))).collect();
    add(&mut page, format_args!("<div class=\"{class}\">\n{sentences}</div>\n"));
    above.iter().for_each(|section| add_section(&mut page, section));
    page += "<h2>Figures</h2>\n";
    for (number, kind) in results.kinds().into_iter().enumerate() {
        let figure = results.figure(kind, None)?;
        let drawing = Drawing::new(&figure, &format!("f{number}"));
        add(
            &mut page,
            format_args!(
                "<figure id=\"{0}\">\n{1}<figcaption><span>{0}</span><span class=\"hint\">{HINT}</span>\
                 <button class=\"reset\" type=\"button\">Whole figure</button></figcaption>\n<div class=\"value\"></div>\n\
                 <script type=\"application/json\">{2}</script>\n</figure>\n",
                kind.name(),
                drawing.svg,
                data::json(&figure, &drawing)
            ),
        );
    }
    below.iter().for_each(|section| add_section(&mut page, section));
    add(&mut page, format_args!("<script>\n{SCRIPT}</script>\n</body>\n</html>\n"));
    Ok(page)
}

fn add(page: &mut String, text: std::fmt::Arguments) {
    // Writing to a string cannot fail.
    let _ = page.write_fmt(text);
}

fn add_section(page: &mut String, section: &Section) {
    add(page, format_args!("<h2>{}</h2>\n", section.heading));
    for part in &section.parts {
        match part {
            Part::Sentence(sentence) => add(page, format_args!("<p>{}</p>\n", escaped(sentence))),
            Part::Text(text) => add(page, format_args!("<pre>{}</pre>\n", escaped(text))),
            Part::Rows(rows) => {
                page.push_str("<table>\n");
                rows.iter().for_each(|row| add_row(page, row));
                page.push_str("</table>\n");
            }
            Part::Table(head, rows) => {
                let line = |tag: &str, cells: &[String]| -> String {
                    cells.iter().map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell))).collect()
                };
                let rows: String = rows.iter().map(|row| format!("<tr>{}</tr>\n", line("td", row))).collect();
                let head = line("th", head);
                add(
                    page,
                    format_args!(
                        "<div class=\"scroll\"><table class=\"wide\">\n<tr>{head}</tr>\n{rows}</table></div>\n"
                    ),
                );
            }
        }
    }
}

fn add_row(page: &mut String, (name, value): &(String, String)) {
    match (name.as_str(), value.as_str()) {
        ("", "") => page.push_str("<tr class=\"gap\"><td></td></tr>\n"),
        (name, "") => add(page, format_args!("<tr><th colspan=\"2\">{}</th></tr>\n", escaped(name))),
        (name, value) => add(
            page,
            format_args!("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escaped(name), escaped(value)),
        ),
    }
}
