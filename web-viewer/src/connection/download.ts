/** Fetches a recording from the server that has written it. `token`: empty if there is none. */
export async function fetchRecording(name: string, token: string): Promise<Blob> {
  const headers: HeadersInit = token ? { Authorization: `Bearer ${token}` } : {};
  const answer = await fetch(`recordings/${encodeURIComponent(name)}`, { headers });
  if (!answer.ok) throw new Error((await answer.text()).trim() || `the server answers ${answer.status}`);
  return answer.blob();
}
