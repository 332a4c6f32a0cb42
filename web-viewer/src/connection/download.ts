/** Fetches a file from the server with this page. `token`: empty if there is none. */
export async function fetchFile(path: string, page: URL, token: string): Promise<Blob> {
  const headers: HeadersInit = token ? { Authorization: `Bearer ${token}` } : {};
  const answer = await fetch(new URL(path, page), { headers });
  if (!answer.ok) throw new Error((await answer.text()).trim() || `the server answers ${answer.status}`);
  return answer.blob();
}
