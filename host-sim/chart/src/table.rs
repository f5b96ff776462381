//! A table of a page.

use maud::{Markup, Render, html};

/// Rows that are shown unfolded.
pub const OPEN: usize = 10;

/// Rows beyond this are left to the JSON output.
const MOST: usize = 500;

/// A table: its rows, and the heading and cells of each column.
pub struct Table<'a, R> {
    name: &'a str,
    rows: &'a [R],
    columns: Vec<(Markup, DrawCell<'a, R>)>,
}

type DrawCell<'a, R> = Box<dyn Fn(&R) -> Markup + 'a>;

/// A table of these rows, still without a column. The name is for screen readers.
pub fn table<'a, R>(name: &'a str, rows: &'a [R]) -> Table<'a, R> {
    Table {
        name,
        rows,
        columns: Vec::new(),
    }
}

impl<'a, R> Table<'a, R> {
    /// With a column of words. The heading may have several lines.
    pub fn words<V: Render>(self, head: &'a str, cell: impl Fn(&R) -> V + 'a) -> Self {
        self.column(head, None, move |row| html! { td { (cell(row)) } })
    }

    /// With a column of words, each with its style class.
    pub fn marked<V: Render>(
        self,
        head: &'a str,
        cell: impl Fn(&R) -> (&'static str, V) + 'a,
    ) -> Self {
        self.column(head, None, move |row| {
            let (class, words) = cell(row);
            html! { td class=(class) { (words) } }
        })
    }

    /// With a column that names the rows.
    pub fn names<V: Render>(self, head: &'a str, cell: impl Fn(&R) -> V + 'a) -> Self {
        self.column(head, None, move |row| html! { th { (cell(row)) } })
    }

    /// With a column of numbers.
    pub fn number<V: Render>(self, head: &'a str, cell: impl Fn(&R) -> V + 'a) -> Self {
        let cell = move |row: &R| html! { td.number { (cell(row)) } };
        self.column(head, Some("number"), cell)
    }

    fn column(mut self, head: &str, class: Option<&str>, cell: impl Fn(&R) -> Markup + 'a) -> Self {
        let mut lines = head.split('\n');
        let first = lines.next().unwrap_or_default();
        let heading = html! { th class=[class] { (first) @for line in lines { br; (line) } } };
        self.columns.push((heading, Box::new(cell)));
        self
    }

    /// Draws it in a container that scrolls. Rows after the first few are folded away.
    pub fn draw(&self) -> Markup {
        let shown = &self.rows[..self.rows.len().min(MOST)];
        let folds = shown.len() > OPEN + 2;
        let (open, folded) = shown.split_at(if folds { OPEN } else { shown.len() });
        let left_out = self.rows.len() - shown.len();
        html! {
            (self.part(open))
            @if !folded.is_empty() {
                details { summary { (folded.len()) " more rows" } (self.part(folded)) }
            }
            @if left_out > 0 { p.note { (left_out) " further rows are in the JSON output only." } }
        }
    }

    fn part(&self, rows: &[R]) -> Markup {
        html! {
            div.scroll tabindex="0" role="region" aria-label=(self.name) {
                table {
                    thead { tr { @for (heading, _) in &self.columns { (heading) } } }
                    tbody { @for row in rows { tr { @for (_, cell) in &self.columns { (cell(row)) } } } }
                }
            }
        }
    }
}
