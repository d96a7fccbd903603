// The JSON documents that the screens show, as the stages print them (docs/reference). Nothing else is shown.

/// The document of a page of `flightwatt report` or `answer`.
export interface ReportDocument {
  title: string;
}

/// Returns the document that the page carries, or null: then the page waits for logs.
export function carriedDocument(): ReportDocument | null {
  const element = document.getElementById("document");
  return element?.textContent?.trim() ? (JSON.parse(element.textContent) as ReportDocument) : null;
}
