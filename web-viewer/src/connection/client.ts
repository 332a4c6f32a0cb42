/** As what the page introduces itself to the server, which tells it to others. */
export const clientName = "spherule viewer";
