#include "fake_app.h"
#include "raw_socket.h"

namespace spherule::net {
namespace {

class Http : public testing::Test {
  protected:
    // Sends one request on a new connection.
    std::string ask(const std::string& firstLine, const std::string& rest = "\r\n") {
        const RawSocket socket(app_.server().port());
        socket.send(firstLine + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + rest);
        return socket.readAll();
    }

    static bool has(const std::string& answer, const std::string& part) {
        return answer.find(part) != std::string::npos;
    }

    FakeApp app_;
};

TEST_F(Http, GetIsAnsweredByTheApp) {
    const auto answer = ask("GET /healthz?probe=1");
    EXPECT_EQ(answer.substr(0, 15), "HTTP/1.1 200 OK") << answer;
    EXPECT_TRUE(has(answer, "Content-Type: text/plain\r\n")) << answer;
    EXPECT_TRUE(has(answer, "Content-Length: 5\r\n")) << answer;
    EXPECT_TRUE(answer.ends_with("\r\n\r\nwell\n")) << answer;
}

TEST_F(Http, HeadHasNoBody) {
    const auto answer = ask("HEAD /healthz");
    EXPECT_EQ(answer.substr(0, 15), "HTTP/1.1 200 OK") << answer;
    EXPECT_TRUE(has(answer, "Content-Length: 5\r\n")) << answer;
    EXPECT_TRUE(answer.ends_with("\r\n\r\n")) << answer;
}

TEST_F(Http, FileIsSentCompressedToWhoAcceptsIt) {
    const auto compressed = ask("GET /file?x", "Accept-Encoding: br;q=0.1\r\nAccept-Encoding: gzip, deflate\r\n\r\n");
    EXPECT_EQ(compressed.substr(0, 15), "HTTP/1.1 200 OK") << compressed;
    for (const std::string header :
         {"Content-Encoding: gzip", "Content-Type: text/css", "Content-Length: 10", "ETag: \"gzip\"",
          "Vary: Accept-Encoding", "Cache-Control: no-cache", "X-Content-Type-Options: nosniff"})
        EXPECT_TRUE(has(compressed, "\r\n" + header + "\r\n")) << header << "\n" << compressed;
    EXPECT_TRUE(compressed.ends_with("\r\n\r\ncompressed")) << compressed;

    for (const std::string rest : {"\r\n", "Accept-Encoding: gzip;q=0, br\r\n\r\n"}) {
        const auto plain = ask("GET /file", rest);
        for (const std::string header :
             {"Content-Type: text/css", "Content-Length: 8", "ETag: \"plain\"", "Vary: Accept-Encoding"})
            EXPECT_TRUE(has(plain, "\r\n" + header + "\r\n")) << header << "\n" << plain;
        EXPECT_FALSE(has(plain, "Content-Encoding")) << plain;
        EXPECT_TRUE(plain.ends_with("\r\n\r\nas it is")) << plain;
    }
}

TEST_F(Http, DownloadIsSentAsAnAttachment) {
    const auto answer = ask("GET /recordings/one.sph?x");
    EXPECT_EQ(answer.substr(0, 15), "HTTP/1.1 200 OK") << answer.substr(0, 500);
    for (const std::string header :
         {"Content-Type: application/octet-stream", "Content-Disposition: attachment; filename=\"one.sph\"",
          "Content-Length: 300000", "X-Content-Type-Options: nosniff", "Cache-Control: no-cache"})
        EXPECT_TRUE(has(answer, "\r\n" + header + "\r\n")) << header << "\n" << answer.substr(0, 500);
    EXPECT_EQ(answer.substr(answer.find("\r\n\r\n") + 4), std::string(300'000, 'r'));

    const auto head = ask("HEAD /recordings/one.sph");
    EXPECT_TRUE(has(head, "\r\nContent-Length: 300000\r\n")) << head;
    EXPECT_TRUE(head.ends_with("\r\n\r\n")) << head;
}

TEST_F(Http, ConnectionGoesOnAfterADownload) {
    const RawSocket socket(app_.server().port());
    for (const std::string method : {"GET", "HEAD"})
        socket.send(method + " /recordings/one.sph HTTP/1.1\r\nHost: localhost\r\n\r\n");
    socket.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    EXPECT_TRUE(socket.readAll().ends_with("\r\n\r\nwell\n"));
}

TEST_F(Http, SceneIsSentPartByPart) {
    const auto answer = ask("GET /scene.json");
    EXPECT_EQ(answer.substr(0, 15), "HTTP/1.1 200 OK") << answer;
    for (const std::string header :
         {"Content-Type: application/json", "Content-Disposition: attachment; filename=\"scene.json\"",
          "Transfer-Encoding: chunked", "X-Content-Type-Options: nosniff"})
        EXPECT_TRUE(has(answer, "\r\n" + header + "\r\n")) << header << "\n" << answer;
    EXPECT_TRUE(answer.ends_with("\r\n\r\n7\r\npart 1\n\r\n7\r\npart 2\n\r\n7\r\npart 3\n\r\n0\r\n\r\n")) << answer;
    const RawSocket old(app_.server().port());
    old.send("GET /scene.json HTTP/1.0\r\nHost: localhost\r\n\r\n");
    const std::string plain = old.readAll();
    EXPECT_TRUE(plain.ends_with("\r\n\r\npart 1\npart 2\npart 3\n")) << plain;
    // The connection goes on.
    const RawSocket socket(app_.server().port());
    for (const std::string method : {"GET", "HEAD"})
        socket.send(method + " /scene.json HTTP/1.1\r\nHost: localhost\r\n\r\n");
    socket.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    EXPECT_TRUE(socket.readAll().ends_with("\r\n\r\nwell\n"));
    app_.takesCommands = false;
    const auto busy = ask("GET /scene.json");
    EXPECT_EQ(busy.substr(9, 3), "503") << busy;
    EXPECT_TRUE(has(busy, "\r\nRetry-After: ")) << busy;
}

TEST_F(Http, OtherDownloadsAreNotThere) {
    for (const std::string path :
         {"/recordings/", "/recordings/../one.sph", "/recordings/two.sph", "/recordings/gone.sph", "/recordings"})
        EXPECT_EQ(ask("GET " + path).substr(9, 3), "404") << path;
}

TEST_F(Http, FileThatTheClientHasIs304WithoutBody) {
    for (const std::string method : {"GET", "HEAD"}) {
        for (const std::string tags :
             {"\"gzip\"", "W/\"gzip\"", "\"old\", \"gzip\"", "\"old\"\r\nIf-None-Match: \"gzip\"", "*"}) {
            const auto answer = ask(method + " /file", "Accept-Encoding: gzip\r\nIf-None-Match: " + tags + "\r\n\r\n");
            EXPECT_EQ(answer.substr(0, 25), "HTTP/1.1 304 Not Modified") << answer;
            for (const std::string header : {"ETag: \"gzip\"", "Vary: Accept-Encoding", "Cache-Control: no-cache",
                                             "X-Content-Type-Options: nosniff"})
                EXPECT_TRUE(has(answer, "\r\n" + header + "\r\n")) << header << "\n" << answer;
            EXPECT_TRUE(has(answer, "\r\nContent-Security-Policy: ")) << answer;
            for (const std::string header : {"Content-Length", "Content-Type", "Content-Encoding", "Transfer-Encoding"})
                EXPECT_FALSE(has(answer, "\r\n" + header + ": ")) << answer;
            EXPECT_TRUE(answer.ends_with("\r\n\r\n")) << answer;
        }
    }
    // The client has another version, or the other form.
    for (const std::string tag : {"\"old\"", "\"plain\""}) {
        const auto answer = ask("GET /file", "Accept-Encoding: gzip\r\nIf-None-Match: " + tag + "\r\n\r\n");
        EXPECT_EQ(answer.substr(0, 12), "HTTP/1.1 200") << answer;
        EXPECT_TRUE(answer.ends_with("\r\n\r\ncompressed")) << answer;
    }
}

TEST_F(Http, HeadOfAFileHasTheHeadersOfGet) {
    const auto answer = ask("HEAD /file", "Accept-Encoding: gzip\r\n\r\n");
    const auto whole = ask("GET /file", "Accept-Encoding: gzip\r\n\r\n");
    EXPECT_EQ(answer + "compressed", whole);
}

TEST_F(Http, ConnectionStaysOpenAfter304) {
    const RawSocket socket(app_.server().port());
    for (int i = 0; i < 3; ++i) {
        socket.send("GET /file HTTP/1.1\r\nHost: localhost\r\nIf-None-Match: \"plain\"\r\n\r\n");
        EXPECT_TRUE(has(socket.readUntil("\r\n\r\n"), "304 Not Modified"));
    }
}

TEST_F(Http, AnswersOfTheAppHaveNoTags) {
    const auto answer = ask("GET /healthz", "Accept-Encoding: gzip\r\nIf-None-Match: *\r\n\r\n");
    EXPECT_TRUE(answer.ends_with("\r\n\r\nwell\n")) << answer;
    for (const std::string header : {"ETag", "Vary", "Content-Encoding"}) EXPECT_FALSE(has(answer, header)) << answer;
}

TEST_F(Http, UnknownPathIs404) {
    EXPECT_EQ(ask("GET /nowhere").substr(0, 12), "HTTP/1.1 404");
}

TEST_F(Http, OtherMethodsAre405) {
    for (const std::string method : {"POST", "PUT", "DELETE", "OPTIONS"}) {
        const auto answer = ask(method + " /healthz");
        EXPECT_EQ(answer.substr(0, 12), "HTTP/1.1 405") << method;
        EXPECT_TRUE(has(answer, "Allow: GET, HEAD\r\n")) << answer;
    }
}

TEST_F(Http, ConnectionServesSeveralRequests) {
    const RawSocket socket(app_.server().port());
    for (int i = 0; i < 3; ++i) {
        socket.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
        EXPECT_TRUE(has(socket.readUntil("well\n"), "200 OK"));
    }
}

TEST_F(Http, LongHeadersAre431) {
    const auto answer = ask("GET /healthz", "X: " + std::string(17'000, 'x') + "\r\n\r\n");
    EXPECT_EQ(answer.substr(0, 12), "HTTP/1.1 431") << answer;
    EXPECT_EQ(ask("GET /healthz", "X: " + std::string(15'000, 'x') + "\r\n\r\n").substr(0, 12), "HTTP/1.1 200");
}

TEST_F(Http, LongBodyIs413) {
    const auto answer = ask("POST /healthz", "Content-Length: 10001\r\n\r\n" + std::string(10'001, 'x'));
    EXPECT_EQ(answer.substr(0, 12), "HTTP/1.1 413") << answer;
}

TEST_F(Http, UnknownTransferEncodingIs501AndCloses) {
    for (const std::string encoding : {"xchunked", "gzip", "chunked, gzip", "chunkedx", ""}) {
        const auto answer =
            ask("GET /healthz", "Transfer-Encoding: " + encoding + "\r\n\r\nGET /nowhere HTTP/1.1\r\n\r\n");
        EXPECT_EQ(answer.substr(0, 12), "HTTP/1.1 501") << encoding;
        EXPECT_FALSE(has(answer, "404")) << encoding;
        EXPECT_TRUE(has(answer, "Connection: close\r\n")) << answer;
    }
    EXPECT_EQ(ask("GET /healthz", "Transfer-Encoding: Chunked\r\n\r\n0\r\n\r\n").substr(0, 12), "HTTP/1.1 200");
}

TEST_F(Http, StreamWithoutUpgradeIs400) {
    const auto answer = ask("GET /ws");
    EXPECT_EQ(answer.substr(0, 12), "HTTP/1.1 400");
    EXPECT_TRUE(has(answer, "open it as a WebSocket with subprotocol spherule.v1")) << answer;
}

TEST_F(Http, UpgradeWithoutKeyIs400) {
    const auto answer = ask("GET /ws",
                            "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                            "Sec-WebSocket-Protocol: spherule.v1\r\n\r\n");
    EXPECT_EQ(answer.substr(0, 12), "HTTP/1.1 400") << answer;
    EXPECT_TRUE(eventually([&] { return app_.counters().sessions == 0; }));
    EXPECT_EQ(app_.counters().accepted, 0U);
}

}  // namespace
}  // namespace spherule::net
