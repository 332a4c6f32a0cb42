// Answers with a document that is made while it is sent.
#include <algorithm>
#include <chrono>
#include <utility>

#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/chunk_encode.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/write.hpp>

#include "net/http.h"

namespace spherule::net {

namespace asio = boost::asio;
namespace http = boost::beast::http;

namespace {

// A client that reads slowly keeps others from saving.
constexpr std::chrono::minutes longestSave{15};

}  // namespace

struct HttpConnection::Sending {
    std::shared_ptr<Document> document;
    std::chrono::steady_clock::time_point end = std::chrono::steady_clock::now() + longestSave;
    http::response<http::empty_body> head{};
    std::optional<http::response_serializer<http::empty_body>> serializer{};  // of the head
    std::string part{};
};

void HttpConnection::answerDocument(const Request& request) {
    tcp().expires_never();
    state_.handlers.saveScene(
        [self = shared_from_this(), request](std::shared_ptr<Document> document, HttpAnswer refusal) {
            asio::post(self->stream_.get_executor(),
                       [self, request, document = std::move(document), refusal = std::move(refusal)] {
                           if (!document) return self->answer(request, refusal);
                           const auto sending = std::make_shared<Sending>(Sending{.document = document});
                           auto& head = sending->head;
                           head.version(request.version());
                           // Clients of HTTP/1.0 know no chunks: the end of the connection ends the body.
                           const bool chunked = request.version() >= 11;
                           head.keep_alive(chunked && request.keep_alive());
                           if (chunked) head.chunked(true);
                           describe(head);
                           head.set(http::field::content_type, "application/json");
                           head.set(http::field::content_disposition, "attachment; filename=\"scene.json\"");
                           sending->serializer.emplace(head);
                           self->tcp().expires_after(self->state_.options.progressTimeout);
                           http::async_write_header(self->stream_, *sending->serializer,
                                                    [self, sending](ErrorCode error, std::size_t) {
                                                        if (!error) self->sendPart(sending);
                                                    });
                       });
        });
}

// The deadline holds for a part, as for recordings.
void HttpConnection::sendPart(const std::shared_ptr<Sending>& sending) {
    if (std::chrono::steady_clock::now() > sending->end) return;
    sending->part = sending->document->next();
    if (sending->part.empty()) return endDocument(sending);
    tcp().expires_after(state_.options.progressTimeout);
    const auto sent = [self = shared_from_this(), sending](ErrorCode error, std::size_t) {
        if (!error) self->sendPart(sending);
    };
    if (sending->head.chunked())
        asio::async_write(stream_, http::make_chunk(asio::buffer(sending->part)), sent);
    else
        asio::async_write(stream_, asio::buffer(sending->part), sent);
}

void HttpConnection::endDocument(const std::shared_ptr<Sending>& sending) {
    sending->document.reset();
    if (!sending->head.chunked()) return shutdown();
    asio::async_write(stream_, http::make_chunk_last(),
                      [self = shared_from_this(), sending](ErrorCode error, std::size_t) {
                          if (error) return;
                          if (!sending->head.keep_alive()) return self->shutdown();
                          self->read();
                      });
}

}  // namespace spherule::net
